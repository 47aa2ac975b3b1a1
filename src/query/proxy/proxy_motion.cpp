#include "proxy_motion.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "geometry/tool/leg_motion.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// If a proxy cannot give way to a whole motion of the organs, it tries this many pieces of it.
constexpr int kPieces = 4;
/// The most bent motions that a proxy tries in order to give way.
constexpr int kMostAttempts = 5;
/// [1] A proxy gives way by at most this many times the depth of tissue in its clearance.
constexpr double kLongestGiveWay = 10.0;
/// In a hollow organ, a place to start is sought along this many straight lines, at most.
constexpr std::size_t kLines = 12;
/// How often a proxy that slides along curved tissue looks for walls, at most.
constexpr int kMostLooks = 8;

// [1] The next three constants are shares of the clearance at rest.

/// A proxy that would slide by less than this has arrived.
constexpr double kConverged = 0.01;
/// How far beyond the clearance the proxy looks for walls, at least and at most.
constexpr double kShortestReach = 1.0;
constexpr double kLongestReach = 20.0;

/// [m] A motion may come nearer to tissue than its start by this allowance for rounding.
constexpr double kRoundingRoom = 1e-9;
/// [m] Poses that differ by less are the same: far below any clearance, and far above rounding.
constexpr double kSamePose = 1e-12;

bool is_same(const ToolPose& a, const ToolPose& b) {
  const auto is_near = [](const auto& x, const auto& y) {
    return (x - y).cwiseAbs().maxCoeff() < kSamePose;
  };
  if (!is_near(a.axis.trocar, b.axis.trocar) || !is_near(a.axis.tip, b.axis.tip)) return false;
  return std::equal(a.links.begin(), a.links.end(), b.links.begin(),
                    [&](const auto& x, const auto& y) { return is_near(x.matrix(), y.matrix()); });
}

/// The pose at a time in [0, 1] of the motion between two poses, as ToolPath defines it.
ToolPose interpolate(const ToolPose& from, const ToolPose& to, double time) {
  const ShaftMotion motion{from.axis, to.axis};
  ToolPose result{motion.at(time), {}, {}};
  for (std::size_t link = 0; link < from.links.size(); ++link) {
    result.links.push_back(RigidMotion(from.links[link], to.links[link]).at(time));
  }
  if (from.tip && to.tip) result.tip = *from.tip + time * (*to.tip - *from.tip);
  return result;
}

/// The pose at a fraction in [0, 1] of a way. All legs of the way take equally long.
ToolPose pose_at(const std::vector<ToolPose>& way, double fraction) {
  const std::size_t legs = way.size() - 1;
  const double along = fraction * static_cast<double>(legs);
  const std::size_t leg = std::min(static_cast<std::size_t>(along), legs - 1);
  return interpolate(way[leg], way[leg + 1], along - static_cast<double>(leg));
}

/// The box around all organs in the proxy's frame [m].
Eigen::AlignedBox3d box_around(const std::vector<OrganTick>& organs) {
  Eigen::AlignedBox3d box;
  for (const OrganTick& organ : organs) {
    const Eigen::AlignedBox3d own = organ.now->box().cast<double>();
    for (int corner = 0; corner < 8; ++corner) {
      const auto type = static_cast<Eigen::AlignedBox3d::CornerType>(corner);
      box.extend(organ.T_now.inverse() * own.corner(type));
    }
  }
  return box;
}

/// The hand's tool, moved straight away from the middle of all organs until it is beyond them.
ToolPose beyond(const std::vector<OrganTick>& organs, const Mobility& mobility,
                const ToolPose& hand) {
  const Eigen::AlignedBox3d box = box_around(organs);
  Vector3d away = mobility.center(hand) - box.center();
  away = away.norm() > 0.0 ? Vector3d(away.normalized()) : Vector3d(Vector3d::UnitZ());
  const double distance = 0.5 * box.diagonal().norm() + 2.0 * mobility.size();
  Displacement displacement = Displacement::Zero();
  displacement.head<3>() = box.center() + distance * away - mobility.center(hand);
  return mobility.moved(hand, displacement, hand);
}

/// The directions from a point to the nearest face of an organ, and to a few faces all over it.
std::vector<Vector3d> lines_to(const OrganTick& organ, const Vector3d& from) {
  const auto to = [&, T_proxy_organ = organ.T_now.inverse()](std::size_t face) -> Vector3d {
    const Vector3d middle = point_at(organ.now->triangle(face), Vector3d::Constant(1.0 / 3.0));
    return T_proxy_organ * middle - from;
  };
  const std::size_t count = organ.now->face_count(), step = (count - 1) / kLines + 1;
  std::vector<Vector3d> lines{to(0)};
  for (std::size_t face = 1; face < count; ++face) {
    const Vector3d line = to(face);
    if (line.squaredNorm() < lines[0].squaredNorm()) lines[0] = line;
  }
  for (std::size_t face = 0; face < count; face += step) lines.push_back(to(face));
  for (Vector3d& line : lines) line.normalize();
  return lines;
}

}  // namespace

std::unique_ptr<const TriangleMesh> shape_between(const TriangleMesh& before,
                                                  const TriangleMesh& now, double time) {
  std::vector<float> vertices(now.vertices().size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const double from = before.vertices()[i], to = now.vertices()[i];
    vertices[i] = static_cast<float>(from + time * (to - from));
  }
  auto shape = std::make_unique<TriangleMesh>(now);
  shape->move_vertices(std::move(vertices));
  return shape;
}

std::optional<ProxyPlace> ProxyMotion::give_way(const ProxyPlace& start, const ToolPose& hand,
                                                const std::vector<OrganTick>& organs) {
  tissue_.set_organs(organs);
  const bool rests = std::none_of(organs.begin(), organs.end(),
                                  [](const OrganTick& organ) { return organ.is_moving(); });
  const ToolPose given = mobility_.combine(start.pose, hand);
  if (rests && is_same(start.pose, given)) return start;
  for (const Level level : {Level::kSwept, Level::kLeast}) {
    if (level == Level::kSwept && start.clearance < clearance_.least()) continue;
    for (const int pieces : {1, kPieces}) {
      if (auto place = give_way(start, hand, organs, level, pieces)) {
        tissue_.set_organs(organs);
        return place;
      }
    }
  }
  tissue_.set_organs(organs);
  return std::nullopt;
}

/// Gives way to the motion of the organs in pieces of equal duration, one after the other.
std::optional<ProxyPlace> ProxyMotion::give_way(const ProxyPlace& start, const ToolPose& hand,
                                                const std::vector<OrganTick>& organs, Level level,
                                                int pieces) {
  const ToolPose given = mobility_.combine(start.pose, hand);
  std::vector<std::unique_ptr<const TriangleMesh>> shapes;  // at the ends of the pieces
  std::vector<OrganTick> piece = organs;
  std::optional<ProxyPlace> place = start;
  for (int i = 0; i < pieces && place; ++i) {
    const bool is_last = i + 1 == pieces;
    const double end = static_cast<double>(i + 1) / pieces;
    for (std::size_t organ = 0; organ < organs.size(); ++organ) {
      const OrganTick& whole = organs[organ];
      OrganTick& tick = piece[organ];
      if (i > 0) {
        tick.before = tick.now;
        tick.T_before = tick.T_now;
      }
      tick.now = whole.now;
      tick.T_now = is_last ? whole.T_now : RigidMotion(whole.T_before, whole.T_now).at(end);
      if (is_last || !whole.before || whole.before == whole.now) continue;
      shapes.push_back(shape_between(*whole.before, *whole.now, end));
      tick.now = shapes.back().get();
    }
    tissue_.set_organs(piece);
    place = give_way(*place, is_last ? hand : interpolate(start.pose, given, end), level);
  }
  return place;
}

/// Sweeps the proxy while the organs move. Each face that the proxy touches becomes a wall, and the
/// motion is bent so that it ends on the free side of all walls.
std::optional<ProxyPlace> ProxyMotion::give_way(const ProxyPlace& start, const ToolPose& hand,
                                                Level level) {
  const ToolPose given = mobility_.combine(start.pose, hand);
  tissue_.touch({start.pose, given}, clearance_.rest, met_, Tissue::Organs::kMove);
  if (met_.empty()) return ProxyPlace{given, clearance_.rest};
  walls_.clear();
  add_walls(given, given, met_);
  const double growth =
      level == Level::kSwept ? growth_from(start.clearance) : tissue_.least_growth();
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    solver_.solve(Displacement::Zero(), walls_);
    const ToolPose pose =
        mobility_.moved(given, share_of_give_way(given) * solver_.displacement(), hand);
    tissue_.touch({start.pose, pose}, growth, met_, Tissue::Organs::kMove);
    if (!first_touch(growth)) {
      return ProxyPlace{pose, level == Level::kSwept ? growth : ProxyPlace().clearance};
    }
    add_walls(given, pose, met_);
  }
  return std::nullopt;
}

/// [1] By which share of the solution the proxy gives way. If walls nearly contradict each other,
/// the solution is far away: the tool would leap out of tissue that squeezes it.
double ProxyMotion::share_of_give_way(const ToolPose& given) const {
  double deepest = 0.0;
  for (const Wall& wall : walls_) deepest = std::max(deepest, -wall.bound);
  const double way = mobility_.longest_way(given, solver_.displacement());
  const double longest = kLongestGiveWay * deepest;
  return way > longest ? longest / way : 1.0;
}

bool ProxyMotion::fly(ProxyPlace& place, const ToolPose& hand, double growth) {
  straight_ = {place.pose, hand};
  tissue_.touch(straight_, growth, met_);
  const auto touch = first_touch(growth);
  if (touch) {
    place.pose = pose_at(straight_, *touch);
  } else {
    place = {hand, growth};
  }
  return !touch;
}

bool ProxyMotion::fly(ProxyPlace& place, const ToolPose& hand) {
  if (!fly(place, hand, clearance_.rest)) return false;
  find_walls(hand, (1.0 + kShortestReach) * clearance_.rest);
  return true;
}

void ProxyMotion::slide(ProxyPlace& place, const ToolPose& hand, double reach) {
  way_ = {place.pose};
  double clearance = place.clearance;
  bool is_there = false;
  for (int look = 0; look < kMostLooks; ++look) {
    reach = std::clamp(reach, kShortestReach * clearance_.rest, kLongestReach * clearance_.rest);
    look_around(place, reach);
    if (look == 0) clearance = place.clearance;
    solver_.solve(mobility_.between(place.pose, hand), walls_);
    const double way = mobility_.longest_way(place.pose, solver_.displacement());
    is_there = way < (solver_.is_held() ? kConverged * clearance_.rest : kSamePose);
    if (is_there) break;
    if (solver_.is_held()) {
      const double share = std::min(1.0, reach / way);
      place.pose = mobility_.moved(place.pose, share * solver_.displacement(), hand);
    } else if (way <= reach) {
      place.pose = hand;
    } else {
      fly(place, hand, growth_from(clearance));
    }
    way_.push_back(place.pose);
    reach = 2.0 * way;
  }
  if (way_.size() == 1) return;
  const double growth = growth_from(clearance);
  tissue_.touch(way_, growth, met_);
  const auto touch = first_touch(growth);
  if (touch) place.pose = pose_at(way_, *touch);
  if (!touch && is_there) return;
  // A proxy that has not arrived may hover far from tissue. Look for the faces that hold it farther
  // and farther away, until there is one.
  reach = kShortestReach * clearance_.rest;
  do {
    look_around(place, reach);
    reach *= 4.0;
  } while (contacts_.empty() && reach <= kLongestReach * clearance_.rest);
}

/// Finds the walls around the proxy, and its clearance.
void ProxyMotion::look_around(ProxyPlace& place, double reach) {
  const double growth = clearance_.rest + reach;
  find_walls(place.pose, growth);
  place.clearance = growth;
  for (const TissueContact& contact : contacts_) {
    place.clearance = std::min(place.clearance, contact.distance);
  }
}

/// Finds the faces that are nearer than `growth` [m] to the proxy at a pose.
void ProxyMotion::find_walls(const ToolPose& pose, double growth) {
  tissue_.touch({pose}, growth, contacts_);
  walls_.clear();
  add_walls(pose, pose, contacts_);
}

/// Adds a wall for each contact: when the motion ends, the tool must be the clearance away from the
/// face. `given`: where displacements begin. `pose`: the end of the motion that met the contacts.
void ProxyMotion::add_walls(const ToolPose& given, const ToolPose& pose,
                            const std::vector<TissueContact>& contacts) {
  const Displacement so_far = mobility_.between(given, pose);
  for (const TissueContact& found : contacts) {
    const Displacement row = mobility_.row(pose, found.contact);
    walls_.push_back({row, found.distance - clearance_.rest + row.dot(so_far)});
  }
}

/// [m] By how much the tool is grown when a motion from a place with this clearance is swept.
double ProxyMotion::growth_from(double clearance) const {
  return std::max(tissue_.least_growth(), std::min(clearance_.swept(), clearance - kRoundingRoom));
}

/// When the last motion first touched tissue, in [0, 1]. With the least growth, the faces that the
/// tool touches from the start do not count: otherwise the tool could not leave them.
std::optional<double> ProxyMotion::first_touch(double growth) const {
  std::optional<double> first;
  for (const TissueContact& met : met_) {
    const double fraction = met.contact.fraction;
    if (growth <= tissue_.least_growth() && fraction == 0.0) continue;
    if (!first || fraction < *first) first = fraction;
  }
  return first;
}

std::optional<ProxyPlace> ProxyMotion::enter(ProxyFreedom freedom, const ToolPose& hand,
                                             const std::vector<OrganTick>& organs,
                                             std::string& why_not) {
  if (freedom == ProxyFreedom::kTrocar) {
    ToolPose pose = hand;
    pose.axis.tip = hand.axis.trocar;
    why_not = "the trocar is in tissue, or on the wrong side of an organ (keep)";
    return first_free({mobility_.combine(pose, hand)});
  }
  if (auto place = first_free({hand})) return place;
  why_not = "there is no room on the right side of all organs (keep)";
  return first_free(starts(hand, organs));
}

/// The first of some poses in which the tool touches nothing and is on the right side.
std::optional<ProxyPlace> ProxyMotion::first_free(const std::vector<ToolPose>& poses) {
  for (const ToolPose& pose : poses) {
    tissue_.touch({pose}, clearance_.rest, met_);
    if (!met_.empty() || tissue_.is_on_wrong_side(tissue_.places_of(pose))) continue;
    return ProxyPlace{pose, clearance_.rest};
  }
  return std::nullopt;
}

/// The places where a free tool may start if it cannot start at the hand, in the order of
/// preference: beyond all organs, and midway between the walls of organs that the tool must not
/// leave, on straight lines from the hand through their faces.
std::vector<ToolPose> ProxyMotion::starts(const ToolPose& hand,
                                          const std::vector<OrganTick>& organs) const {
  const Vector3d from = mobility_.center(hand);
  const double length = box_around(organs).extend(from).diagonal().norm();
  std::vector<Vector3d> ways;  // from the hand
  for (const OrganTick& organ : organs) {
    if (organ.keep != Side::kInside) continue;
    for (const Vector3d& line : lines_to(organ, from)) {
      const std::vector<ProxyCrossing> walls =
          tissue_.cross({from - length * line, from + length * line});
      for (std::size_t i = 1; i < walls.size(); ++i) {
        ways.push_back(0.5 * (walls[i - 1].point + walls[i].point) - from);
      }
    }
  }
  std::stable_sort(ways.begin(), ways.end(),
                   [](const auto& a, const auto& b) { return a.norm() < b.norm(); });
  std::vector<ToolPose> places = {beyond(organs, mobility_, hand)};
  for (const Vector3d& way : ways) {
    Displacement displacement = Displacement::Zero();
    displacement.head<3>() = way;
    places.push_back(mobility_.moved(hand, displacement, hand));
  }
  return places;
}

}  // namespace organ_collision
