#include "tissue.hpp"

#include <algorithm>

namespace organ_collision {
namespace {

/// [m] The radius of a middle line, and of a shaft that is made as thin as its axis.
constexpr double kAxisRadius = 1e-6;

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

}  // namespace

Tissue::Tissue(const ProxyTool& tool, const PickerSettings& picker)
    : tool_(tool), grown_links_(tool.links), middle_lines_(tool.links), query_(picker) {
  for (Link& link : middle_lines_) {
    std::transform(link.parts.begin(), link.parts.end(), link.parts.begin(), middle_line);
  }
}

double Tissue::least_growth() const { return -std::max(kAxisRadius, tool_.radius - kAxisRadius); }

void Tissue::touch(const std::vector<ToolPose>& way, double growth,
                   std::vector<TissueContact>& contacts, Organs organs) {
  contacts.clear();
  const bool is_thin = growth < 0.0;
  const double radius = tool_.radius > 0.0 ? std::max(kAxisRadius, tool_.radius + growth) : 0.0;
  for (std::size_t link = 0; link < grown_links_.size(); ++link) {
    const std::vector<LinkPart>& parts = tool_.links[link].parts;
    for (std::size_t part = 0; part < parts.size(); ++part) {
      grown_links_[link].parts[part].radius = parts[part].radius + std::max(0.0, growth);
    }
  }
  const AskedTool grown{radius, is_thin ? &middle_lines_ : &grown_links_};
  for (std::size_t organ = 0; organ < organs_->size(); ++organ) {
    const OrganTick& tick = (*organs_)[organ];
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
    const Eigen::Isometry3d T_proxy_organ = tick.T_now.inverse();
    for (const FaceContact& found : result_.contacts) {
      // A middle line has grown by its whole radius.
      const double growth_of_link = is_thin ? kAxisRadius : growth;
      const double grown_by = found.link == kShaft ? radius - tool_.radius : growth_of_link;
      TissueContact contact{organ, found, grown_by - found.depth};
      contact.contact.point = T_proxy_organ * found.point;
      contact.contact.on_organ = T_proxy_organ * found.on_organ;
      contact.contact.normal = T_proxy_organ.linear() * found.normal;
      contacts.push_back(contact);
    }
  }
}

std::vector<ShaftAxis> Tissue::places_of(const ToolPose& pose) const {
  std::vector<ShaftAxis> places;
  if (tool_.radius > 0.0) places.push_back(pose.axis);
  for (std::size_t link = 0; link < tool_.links.size(); ++link) {
    for (const LinkPart& part : tool_.links[link].parts) {
      const Eigen::Vector3d point =
          pose.links[link] * (part.surface ? part.surface->vertices()[0] : part.core.points[0]);
      places.push_back({point, point});
    }
  }
  return places;
}

bool Tissue::is_on_wrong_side(const std::vector<ShaftAxis>& places) {
  const auto is_wrong = [](const OrganTick& organ, Side side) {
    return (organ.keep == Side::kOutside && side == Side::kInside) ||
           (organ.keep == Side::kInside && side == Side::kOutside);
  };
  for (const OrganTick& organ : *organs_) {
    for (const ShaftAxis& place : places) {
      const AxisPlacement& found = placement(organ, place, organ.topology);
      if (is_wrong(organ, found.tip) || is_wrong(organ, found.trocar)) return true;
      if (!found.crossings.empty()) return true;
    }
  }
  return false;
}

std::vector<ProxyCrossing> Tissue::cross(const ShaftAxis& axis) {
  std::vector<ProxyCrossing> crossings;
  for (std::size_t organ = 0; organ < organs_->size(); ++organ) {
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
