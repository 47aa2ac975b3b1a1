#include "tissue.hpp"

#include <algorithm>

#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {
namespace {

/// [m] The radius of a shaft that stands for its axis.
constexpr double kAxisRadius = 1e-6;

ToolWaypoint waypoint(double fraction, const Eigen::Isometry3d& T_organ_proxy,
                      const ToolPose& pose) {
  ToolWaypoint result{
      fraction, {T_organ_proxy * pose.axis.trocar, T_organ_proxy * pose.axis.tip}, pose.links};
  for (Eigen::Isometry3d& link : result.links) link = T_organ_proxy * link;
  return result;
}

}  // namespace

Tissue::Tissue(const ProxyTool& tool, PickerKind picker)
    : tool_(tool), grown_links_(tool.links), query_(picker) {
  if (!grown_links_.empty()) request_.links = &grown_links_;
}

bool Tissue::is_inside(const ToolPose& pose, const Eigen::Vector3d& point) {
  grow(0.0);
  request_.placement = true;
  bool is_inside = false;
  for (const OrganTick& organ : *organs_) {
    request_.path = {waypoint(0.0, organ.T_now, pose)};
    request_.surface_topology = organ.topology;
    request_.tip = organ.T_now * point;
    evaluate(organ, QueryMode::kStatic, false);
    const AxisPlacement& placement = result_.placement;
    is_inside = is_inside || placement.tip == Side::kInside || placement.trocar == Side::kInside ||
                !placement.crossings.empty();
  }
  request_.placement = false;
  request_.surface_topology = nullptr;
  request_.tip.reset();
  return is_inside;
}

double Tissue::least_growth() const {
  return tool_.radius > 0.0 ? std::min(0.0, kAxisRadius - tool_.radius) : 0.0;
}

void Tissue::touch(const ToolPose& pose, double growth, std::vector<TissueContact>& contacts) {
  contacts.clear();
  grow(growth);
  for (std::size_t organ = 0; organ < organs_->size(); ++organ) {
    const OrganTick& tick = (*organs_)[organ];
    request_.path = {waypoint(0.0, tick.T_now, pose)};
    evaluate(tick, QueryMode::kStatic, false);
    collect(organ, tick.T_now, contacts);
  }
}

void Tissue::sweep(const std::vector<ToolPose>& way, double growth,
                   std::vector<TissueContact>& contacts) {
  contacts.clear();
  grow(growth);
  const double legs = static_cast<double>(way.size() - 1);
  for (std::size_t organ = 0; organ < organs_->size(); ++organ) {
    const OrganTick& tick = (*organs_)[organ];
    request_.path.clear();
    for (std::size_t i = 0; i < way.size(); ++i) {
      const double fraction = legs > 0.0 ? static_cast<double>(i) / legs : 0.0;
      request_.path.push_back(waypoint(fraction, tick.T_now, way[i]));
    }
    evaluate(tick, QueryMode::kSwept, false);
    collect(organ, tick.T_now, contacts);
  }
}

void Tissue::sweep_with_organs(const ToolPose& from, const ToolPose& to, double growth,
                               std::vector<TissueContact>& contacts) {
  contacts.clear();
  grow(growth);
  for (std::size_t organ = 0; organ < organs_->size(); ++organ) {
    const OrganTick& tick = (*organs_)[organ];
    request_.path = {waypoint(0.0, tick.T_before, from), waypoint(1.0, tick.T_now, to)};
    evaluate(tick, QueryMode::kSwept, true);
    collect(organ, tick.T_now, contacts);
  }
}

void Tissue::grow(double growth) {
  growth_ = growth;
  request_.radius = tool_.radius > 0.0 ? std::max(kAxisRadius, tool_.radius + growth) : 0.0;
  for (std::size_t link = 0; link < grown_links_.size(); ++link) {
    for (std::size_t part = 0; part < grown_links_[link].parts.size(); ++part) {
      grown_links_[link].parts[part].radius =
          tool_.links[link].parts[part].radius + std::max(0.0, growth);
    }
  }
}

/// [m] By how much a link has grown. Links do not shrink.
double Tissue::growth_of(std::uint32_t link) const {
  const bool is_shaft = tool_.radius > 0.0 && link == 0;
  return is_shaft ? request_.radius - tool_.radius : std::max(0.0, growth_);
}

void Tissue::evaluate(const OrganTick& organ, QueryMode mode, bool moves) {
  request_.organ = organ.now;
  request_.organ_before = moves && organ.before != organ.now ? organ.before : nullptr;
  request_.mode = mode;
  query_.evaluate(request_, result_);
}

/// Adds the contacts, in the proxy's frame.
void Tissue::collect(std::size_t organ, const Eigen::Isometry3d& T_organ_proxy,
                     std::vector<TissueContact>& contacts) {
  const Eigen::Isometry3d T_proxy_organ = T_organ_proxy.inverse();
  for (const FaceContact& found : result_.contacts) {
    TissueContact contact{organ, found, growth_of(found.link) - found.depth};
    contact.contact.point = T_proxy_organ * found.point;
    contact.contact.end_point = T_proxy_organ * found.end_point;
    contact.contact.normal = T_proxy_organ.linear() * found.normal;
    contacts.push_back(contact);
  }
}

}  // namespace organ_collision
