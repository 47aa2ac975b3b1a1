#include "tissue.hpp"

#include <algorithm>
#include <tuple>

#include "geometry/tool/leg_motion.hpp"

namespace organ_collision {
namespace {

/// [m] The radius of a middle line, and of a shaft that is made as thin as its axis.
constexpr double kAxisRadius = 1e-6;

/// [s] A row stands for no tissue that will be nearer so much later: many periods of a controller.
constexpr double kSoon = 0.1;

constexpr QueryOptions kPlacement{QueryMode::kStatic, false, 0.0, 0, false, true};

/// The middle line of a part: the segment through the middle of its box, along the longest side.
LinkPart middle_line(const LinkPart& part) {
  const OrientedBox& box = part.bounds;
  Eigen::Index longest = 0;
  const double length = box.half_size.maxCoeff(&longest);
  const Eigen::Vector3d along = length * box.axes.col(longest);
  OrientedBox bounds{box.center, box.axes, Eigen::Vector3d::Zero()};
  bounds.half_size[longest] = length;
  return {ShaftAxis{box.center - along, box.center + along}, nullptr, kAxisRadius, bounds};
}

ToolWaypoint waypoint(double fraction, const Eigen::Isometry3d& T_organ_proxy,
                      const ToolPose& pose) {
  ToolWaypoint result{
      fraction, {T_organ_proxy * pose.axis.trocar, T_organ_proxy * pose.axis.tip}, pose.links};
  for (Eigen::Isometry3d& link : result.links) link = T_organ_proxy * link;
  return result;
}

/// What counts of a way or a speed: only towards the tool, up to `most`, and not if it is NaN.
double counted(double value, double most) { return std::max(0.0, std::min(value, most)); }

/// How far an organ's tissue has come since its shape was measured, or will have come `later` [s].
PatchFinder::Coming coming(const OrganTick& organ, double later) {
  const ProxyOrgan* const given = organ.given;
  const bool is_late = given && given->advance, comes = given && given->approach && later > 0.0;
  if (!is_late && !comes) return {};
  const auto against =
      [=, &mesh = *organ.now, T_proxy_organ = Eigen::Isometry3d(organ.T_now.inverse())](
          std::uint32_t face, const Triangle& corners, const Eigen::Vector3d& normal) {
        FaceContact at;
        at.face = face;
        at.vertices = mesh.faces()[face];
        at.normal = T_proxy_organ.linear() * normal;
        Eigen::Vector3d ways = Eigen::Vector3d::Zero();
        for (int k = 0; k < 3; ++k) {
          at.barycentric = Eigen::Vector3d::Unit(k);
          at.point = at.on_organ = T_proxy_organ * corners[k];
          if (is_late) ways[k] += counted(given->advance(at), given->most_advance);
          if (comes) ways[k] += later * counted(given->approach(at), given->most_approach);
        }
        return ways;
      };
  return {against,
          (is_late ? given->most_advance : 0.0) + (comes ? later * given->most_approach : 0.0)};
}

}  // namespace

Tissue::Tissue(const ProxyTool& tool, const PickerSettings& picker)
    : tool_(tool), grown_links_(tool.links), middle_lines_(tool.links), query_(picker) {
  for (Link& link : middle_lines_) {
    std::transform(link.parts.begin(), link.parts.end(), link.parts.begin(), middle_line);
  }
}

double Tissue::least_growth() const { return -std::max(kAxisRadius, tool_.radius - kAxisRadius); }

double Tissue::clearance(const OrganTick& organ, std::int32_t link) const {
  return organ.clearances.empty() ? clearance_.rest : organ.clearances[part_index(link)];
}

/// The parts of the tool that an organ holds, grown. Without `links` if it holds none.
AskedTool Tissue::grow(const OrganTick& organ, double growth) {
  double radius = 0.0;
  bool holds = false;
  grown_by_.assign(1 + grown_links_.size(), growth);
  for (std::size_t part = 0; part < grown_by_.size(); ++part) {
    const double own = clearance(organ, static_cast<std::int32_t>(part) - 1);
    double& grown = grown_by_[part];
    if (part == 0 || growth >= 0.0) grown = clearance_.distance(growth, own);
    if (part == 0) {
      if (tool_.radius > 0.0 && own > 0.0) radius = std::max(kAxisRadius, tool_.radius + grown);
      grown = radius - tool_.radius;
      continue;
    }
    std::vector<LinkPart>& parts = grown_links_[part - 1].parts;
    parts.clear();
    if (own > 0.0) parts = (growth < 0.0 ? middle_lines_ : tool_.links)[part - 1].parts;
    for (LinkPart& of_link : parts) of_link.radius += std::max(0.0, grown);
    if (growth < 0.0) grown = kAxisRadius;  // A middle line has grown by its whole radius.
    holds = holds || !parts.empty();
  }
  return {radius, holds || radius > 0.0 ? &grown_links_ : nullptr};
}

void Tissue::touch(const std::vector<ToolPose>& way, double growth,
                   std::vector<TissueContact>& contacts, Organs organs) {
  contacts.clear();
  for (std::size_t organ = 0; organ < organs_->size(); ++organ) {
    const OrganTick& tick = (*organs_)[organ];
    const AskedTool grown = grow(tick, growth);
    if (!grown.links) continue;
    const bool moves = organs == Organs::kMove;
    ToolPath path = {waypoint(0.0, moves ? tick.T_before : tick.T_now, way[0])};
    for (std::size_t i = 1; i < way.size(); ++i) {
      const double fraction = static_cast<double>(i) / static_cast<double>(way.size() - 1);
      path.push_back(waypoint(fraction, tick.T_now, way[i]));
    }
    const QueryMode mode = path.size() == 1 ? QueryMode::kStatic : QueryMode::kSwept;
    query_.evaluate(
        make_request({tick.now, moves ? tick.before : nullptr}, grown, {mode}, std::move(path)),
        result_);
    count(result_.picked.drawn + result_.picked.undrawn);
    for (const FaceContact& found : result_.contacts) {
      add(organ, found, grown_by_[part_index(found.link)], contacts);
    }
  }
}

/// Adds a contact of a tool that is grown by `grown_by` [m], in the organ's frame.
TissueContact& Tissue::add(std::size_t organ, const FaceContact& found, double grown_by,
                           std::vector<TissueContact>& contacts) const {
  const OrganTick& tick = (*organs_)[organ];
  const Eigen::Isometry3d T_proxy_organ = tick.T_now.inverse();
  const double own = clearance(tick, found.link), distance = grown_by - found.depth;
  TissueContact contact{organ, found, distance, own, clearance_.scaled(distance, own)};
  contact.contact.point = T_proxy_organ * found.point;
  contact.contact.on_organ = T_proxy_organ * found.on_organ;
  contact.contact.normal = T_proxy_organ.linear() * found.normal;
  if (tick.given && tick.given->advance) {
    contact.clearance += counted(tick.given->advance(contact.contact), tick.given->most_advance);
  }
  contacts.push_back(contact);
  return contacts.back();
}

/// Sets how far from an organ each part of the tool looks.
void Tissue::set_limits(const OrganTick& organ, const PatchFinder::Limits& limits, double reach) {
  limits_.clear();
  const double advance = organ.given && organ.given->advance ? organ.given->most_advance : 0.0;
  for (std::size_t part = 0; part <= tool_.links.size(); ++part) {
    const double own = clearance(organ, static_cast<std::int32_t>(part) - 1);
    const double more = own - clearance_.rest;
    const double distance = std::max(limits.distance + (more + advance), reach);
    limits_.push_back({own > 0.0 ? distance : 0.0, limits.patch, limits.clearance + more});
  }
}

bool Tissue::look(const ToolPose& pose, const PatchFinder::Limits& limits,
                  std::vector<TissueContact>& contacts, double reach) {
  contacts.clear();
  bool is_complete = true;
  for (std::size_t organ = 0; organ < organs_->size(); ++organ) {
    const OrganTick& tick = (*organs_)[organ];
    const CollisionRequest request = make_request({tick.now}, {tool_.radius, &tool_.links}, {},
                                                  {waypoint(0.0, tick.T_now, pose)});
    BlockBoxes unused;
    std::size_t tests = tests_;
    found_.clear();
    set_limits(tick, limits, reach);
    const PatchFinder::Coming late = coming(tick, 0.0),
                              soon = coming(tick, reach > 0.0 ? kSoon : 0.0);
    if (!patches_.find(Step(request, request.path, unused), limits_, late, soon, tests, found_)) {
      is_complete = false;
    }
    count(tests_ - tests);
    // A face has one contact with a link, whichever part of the link is the nearest.
    std::sort(found_.begin(), found_.end(), [](const auto& a, const auto& b) {
      return std::make_tuple(a.contact.face, a.contact.link, -a.contact.depth - a.advance) <
             std::make_tuple(b.contact.face, b.contact.link, -b.contact.depth - b.advance);
    });
    const auto end = std::unique(found_.begin(), found_.end(), [](const auto& a, const auto& b) {
      return a.contact.face == b.contact.face && a.contact.link == b.contact.link;
    });
    for (auto found = found_.begin(); found != end; ++found) {
      TissueContact& near = add(organ, found->contact, 0.0, contacts);
      // Other places of the face may come nearer than the one that is the nearest now.
      near.clearance =
          std::max(near.clearance, clearance(organ, near.contact.link) + found->advance);
    }
  }
  const double most = limits.distance - clearance_.rest;
  const auto is_far = [&](const TissueContact& found) {
    return found.spare() > most && found.distance > reach;
  };
  contacts.erase(std::remove_if(contacts.begin(), contacts.end(), is_far), contacts.end());
  std::stable_sort(contacts.begin(), contacts.end(), [](const auto& a, const auto& b) {
    return std::make_pair(a.spare(), a.distance) < std::make_pair(b.spare(), b.distance);
  });
  return is_complete;
}

/// Counts tests of a face against a part of the tool.
void Tissue::count(std::size_t tests) {
  tests_made_ += tests;
  tests_ -= std::min(tests, tests_);
}

/// The velocity of a point of a link is v + w x R (c + q), with the link's ball around c. The mean
/// of v + w x R c is how far c moves, from which it differs by at most |w|^2 |c|.
double Tissue::farthest_move(const ToolPose& from, const ToolPose& to) const {
  double most = 0.0;
  if (tool_.radius > 0.0) {
    most =
        std::max((to.axis.trocar - from.axis.trocar).norm(), (to.axis.tip - from.axis.tip).norm());
  }
  for (std::size_t link = 0; link < tool_.links.size(); ++link) {
    const LinkBall ball = ball_around(tool_.links[link]);
    const RigidMotion motion(from.links[link], to.links[link]);
    const double angle = motion.angle();
    most = std::max(most, (motion.end() * ball.center - motion.start() * ball.center).norm() +
                              angle * (ball.radius + angle * ball.center.norm()));
  }
  return most;
}

std::vector<ShaftAxis> Tissue::places_of(const ToolPose& pose, const OrganTick& organ) const {
  std::vector<ShaftAxis> places;
  if (tool_.radius > 0.0 && clearance(organ, kShaft) > 0.0) places.push_back(pose.axis);
  for (std::size_t link = 0; link < tool_.links.size(); ++link) {
    if (!(clearance(organ, static_cast<std::int32_t>(link)) > 0.0)) continue;
    for (const LinkPart& part : tool_.links[link].parts) {
      const Eigen::Vector3d point =
          pose.links[link] * (part.surface ? part.surface->vertices()[0] : part.core.points[0]);
      places.push_back({point, point});
    }
  }
  return places;
}

bool Tissue::is_on_wrong_side(const ToolPose& pose, bool only_first) {
  const auto is_wrong = [](const OrganTick& organ, Side side) {
    return (organ.keep == Side::kOutside && side == Side::kInside) ||
           (organ.keep == Side::kInside && side == Side::kOutside);
  };
  for (const OrganTick& organ : *organs_) {
    for (const ShaftAxis& place : places_of(pose, organ)) {
      const AxisPlacement& found = placement(organ, place, organ.topology);
      if (is_wrong(organ, found.tip) || is_wrong(organ, found.trocar)) return true;
      if (!found.crossings.empty()) return true;
      if (only_first && !organ.holds_more) break;
    }
  }
  return false;
}

std::vector<ProxyCrossing> Tissue::cross(const ShaftAxis& axis) {
  std::vector<ProxyCrossing> crossings;
  for (std::size_t organ = 0; organ < organs_->size(); ++organ) {
    if (tool_.radius > 0.0 && !(clearance(organ, kShaft) > 0.0)) continue;
    const Eigen::Isometry3d T_proxy_organ = (*organs_)[organ].T_now.inverse();
    for (const AxisCrossing& found : placement((*organs_)[organ], axis, nullptr).crossings) {
      crossings.push_back({organ, found.face, found.barycentric, found.shaft,
                           T_proxy_organ * found.point, Eigen::Vector3d::Zero()});
    }
  }
  std::stable_sort(crossings.begin(), crossings.end(),
                   [](const auto& a, const auto& b) { return a.shaft < b.shaft; });
  return crossings;
}

/// Where an axis is. Without a topology, the sides of its ends are not looked for.
const AxisPlacement& Tissue::placement(const OrganTick& organ, const ShaftAxis& axis,
                                       const SurfaceTopology* topology) {
  query_.evaluate(make_request({organ.now, nullptr, nullptr, 0.0, topology}, {kAxisRadius},
                               kPlacement, {waypoint(0.0, organ.T_now, {axis, {}, {}})}),
                  result_);
  return result_.placement;
}

}  // namespace organ_collision
