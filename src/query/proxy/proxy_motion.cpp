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
constexpr int kMostLooks = 6;

/// A proxy that would slide by less than the larger of these has arrived: a share [1] of the
/// clearance at rest, and a length [m], of small clearances a hundredth.
constexpr double kConverged = 0.0025, kSmallestSlide = 1e-6;
/// [m] How far a proxy slides from one look to the next, at most. It looks at least so far, and at
/// most so far, beyond its clearance.
constexpr double kShortestReach = 1e-4, kLongestReach = 2e-3;
/// [1] A proxy that hovers looks for the faces that hold it up to this many times its clearance.
constexpr double kFarthestLook = 21.0;

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
      if (pieces > 1 && tissue_.is_used_up()) continue;
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
  const double growth =
      level == Level::kSwept ? growth_from(start.clearance) : tissue_.least_growth();
  if (level == Level::kSwept) {
    // Most often the tissue stays away. This sweep costs less than one at the whole clearance.
    tissue_.touch({start.pose, given}, growth, met_, Tissue::Organs::kMove);
    if (!first_touch(growth)) return ProxyPlace{given, growth};
  }
  tissue_.touch({start.pose, given}, clearance_.rest, met_, Tissue::Organs::kMove);
  if (met_.empty()) return ProxyPlace{given, clearance_.rest};
  walls_.clear();
  add_walls(given, given, met_);
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

/// A look at the hand tells most often that the way there is clear.
bool ProxyMotion::fly(ProxyPlace& place, const ToolPose& hand) {
  ProxyPlace there{hand};
  const double way = tissue_.farthest_move(place.pose, hand);
  if (way > kLongestReach) {
    if (tissue_.is_used_up() || place.clearance < clearance_.rest) return false;
    if (!fly(place, hand, clearance_.rest)) return false;
    there.clearance = place.clearance;
    look_around(there, clearance_.told());
    if (!contacts_.empty() && contacts_.front().spare() < 0.0) return false;
  } else {
    const double distance = std::max(clearance_.told(), clearance_.rest + 2.0 * way);
    if (!look_around(there, distance)) return false;
    if (!contacts_.empty() && contacts_.front().spare() < 0.0) return false;
    const double growth = growth_from(place.clearance);
    if (!is_clear({place.pose}, there, clearance_.rest) && !is_clear(place, there, growth) &&
        !fly(place, hand, growth)) {
      return false;
    }
  }
  place = there;
  return true;
}

void ProxyMotion::slide(ProxyPlace& place, const ToolPose& hand, double reach) {
  way_.clear();
  const ProxyPlace start = place;
  const double converged =
      std::max(kConverged * clearance_.rest, std::min(kSmallestSlide, 0.01 * clearance_.rest));
  ProxyPlace last;
  double growth = 0.0;
  bool is_there = false, tells = false;
  std::size_t unproven = 0;  // so many of the first places of the way are not known to be clear
  for (int look = 1; look <= kMostLooks; ++look) {
    reach = std::clamp(reach, kShortestReach, kLongestReach);
    // The first look finds where to go. At a large clearance, the second one most often finds that
    // the proxy is there, and all that the answer tells.
    const double distance = clearance_.rest + reach;
    tells = look > 1;
    if (!look_around(place, tells ? std::max(distance, clearance_.told()) : distance)) {
      return stay_at(place, start);
    }
    if (look == 1) growth = growth_from(place.clearance);
    way_.push_back(place.pose);
    if (look > 1 && !is_clear(last, place, growth)) unproven = way_.size();
    Displacement goal = mobility_.between(place.pose, hand);
    const bool goes_on = look < kMostLooks - 1;
    // If the place is not found in this tick, the last step only restores the clearance.
    const double off = 2.0 * std::abs(contacts_.empty() ? place.clearance - clearance_.rest
                                                        : contacts_.front().spare());
    if (!goes_on && goal.norm() > off) goal *= off / goal.norm();
    solver_.solve(goal, walls_);
    const double way = mobility_.longest_way(place.pose, solver_.displacement());
    const bool stays = way < (solver_.is_held() ? converged : kSamePose);
    is_there = stays && goes_on;
    if (stays || look == kMostLooks) break;
    last = place;
    if (solver_.is_held() || !goes_on) {
      const double share = std::min(1.0, reach / way);
      place.pose = mobility_.moved(place.pose, share * solver_.displacement(), hand);
    } else if (way <= reach) {
      place.pose = hand;
    } else if (reach == kLongestReach) {
      fly(place, hand,
          std::max(growth, std::min(clearance_.rest, place.clearance - kRoundingRoom)));
    }  // Otherwise the next look sees farther from the same place.
    reach = 2.0 * way;
  }
  if (unproven > 0) {
    if (tissue_.is_used_up()) return stay_at(place, start);
    way_.resize(unproven);
    tissue_.touch(way_, growth, met_);
    if (const auto touch = first_touch(growth)) {
      place = {pose_at(way_, *touch), growth};
      is_there = tells = false;
    }
  }
  // A proxy that has not arrived may hover far from tissue. Look for the faces that hold it farther
  // and farther away, until there is one.
  double distance = clearance_.told();
  if (!tells) look_around(place, distance);
  while (!is_there && contacts_.empty() && distance < kFarthestLook * clearance_.rest) {
    distance *= 2.0;
    look_around(place, distance);
  }
}

/// The work of a tick is used up before a motion from `start` was proven to be free.
void ProxyMotion::stay_at(ProxyPlace& place, const ProxyPlace& start) {
  place = start;
  contacts_.clear();
  walls_.clear();
}

/// Finds the walls up to a distance [m] around the proxy, one for each patch, and its clearance.
/// Returns false if the work of the tick is used up: the clearance is not known then.
bool ProxyMotion::look_around(ProxyPlace& place, double distance) {
  // A wall must hold as far as the proxy slides.
  const double patch = std::max(clearance_.rest, kLongestReach);
  const bool is_complete = tissue_.look(place.pose, {distance, patch, clearance_.rest}, contacts_);
  walls_.clear();
  add_walls(place.pose, place.pose, contacts_);
  if (!is_complete) return false;
  place.clearance = distance;
  for (const TissueContact& found : contacts_) {
    place.clearance = std::min(place.clearance, found.scaled);
  }
  return true;
}

/// Whether the scaled distances at both ends prove that the straight way between two places stays
/// farther than `growth` [m] from tissue: a distance changes by at most what the tool moves.
bool ProxyMotion::is_clear(const ProxyPlace& from, const ProxyPlace& to, double growth) const {
  const double way = tissue_.farthest_move(from.pose, to.pose);
  const double least = std::max(0.5 * (from.clearance + to.clearance - way), to.clearance - way);
  return least > std::max(growth, 0.0) + kRoundingRoom;
}

/// Adds a wall for each contact: when the motion ends, the tool must be the clearance away from the
/// face. `given`: where displacements begin. `pose`: the end of the motion that met the contacts.
void ProxyMotion::add_walls(const ToolPose& given, const ToolPose& pose,
                            const std::vector<TissueContact>& contacts) {
  const Displacement so_far = mobility_.between(given, pose);
  for (const TissueContact& found : contacts) {
    const Displacement row = mobility_.row(pose, found.contact);
    walls_.push_back({row, found.spare() + row.dot(so_far)});
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
    const bool touched_first = fraction == 0.0 && met.contact.is_resolved;
    if (growth <= tissue_.least_growth() && touched_first) continue;
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
    if (!met_.empty() || tissue_.is_on_wrong_side(pose)) continue;
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
        ways.emplace_back(0.5 * (walls[i - 1].point + walls[i].point) - from);
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
