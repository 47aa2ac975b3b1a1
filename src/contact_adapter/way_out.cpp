#include "way_out.hpp"

#include <algorithm>

#include "geometry/concatenate.hpp"
#include "ros/interface/conversions.hpp"
#include "ros/interface/rejection.hpp"
#include "shaft_radius.hpp"

namespace organ_collision {
namespace {

bool is_inside(const ContactArray& answer) {
  const ToolPlacement& placement = answer.placement;
  if (answer.clearance.state == Clearance::NOT_ASKED) return false;
  if (placement.tip != ToolPlacement::INSIDE || !placement.crossings.empty()) return false;
  const bool has_shaft = !answer.links.empty() && is_shaft(0, answer);
  const std::uint8_t needed = has_shaft ? ToolPlacement::INSIDE : ToolPlacement::UNKNOWN;
  if (placement.trocar != needed) return false;
  return (has_shaft && answer.links.size() == 1) || answer.contacts.empty();
}

bool is_pushing(const Push& push) { return push.counts && push.depth > 0.0; }

void refuse_unknown_way(const Clearance& clearance) {
  const auto refuse = [](const std::string& why) {
    throw Rejection(ContactArray::INVALID_REQUEST, "way out unknown",
                    "the tool is inside the organ and touches nothing; " + why);
  };
  if (clearance.state != Clearance::KNOWN) {
    refuse(concatenate("no face is within the margin of ", clearance.margin,
                       " m, which must be larger than the depth"));
  }
  if (clearance.unresolved) refuse("its clearance was not resolved");
  if (!clearance.normal_defined) refuse("the normal of its clearance is not defined");
}

}  // namespace

KeptSides::DepthsInside WayOut::depths_inside(const ContactArray& answer,
                                              const KeptSides::Radius& shaft_radius) const {
  KeptSides::DepthsInside depths;
  for (std::uint32_t link = 0; link < answer.links.size(); ++link) {
    const auto known = depths_.find(link);
    depths[link] = known == depths_.end() ? 0.0 : known->second;
    if (shaft_radius && is_shaft(link, answer)) depths[link] = 2.0 * *shaft_radius;
  }
  return depths;
}

void WayOut::keep_depths(const ContactArray& answer, const std::vector<Push>& pushes) {
  for (const Contact& contact : answer.contacts) depths_[contact.link] = 0.0;
  for (std::size_t i = 0; i < answer.contacts.size(); ++i) {
    double& depth = depths_[answer.contacts[i].link];
    if (is_pushing(pushes[i])) depth = std::max(depth, pushes[i].depth);
  }
}

Push WayOut::push_out(const ContactArray& answer, const KeptSides::Radius& shaft_radius) const {
  const Clearance& clearance = answer.clearance;
  refuse_unknown_way(clearance);
  const KeptSides::DepthsInside depths = depths_inside(answer, shaft_radius);
  const auto depth = depths.find(clearance.link);
  return {to_eigen(clearance.on_organ), -to_eigen(clearance.normal),
          clearance.distance + (depth == depths.end() ? 0.0 : depth->second), true};
}

std::vector<Push> WayOut::follow(const ContactArray& answer,
                                 const KeptSides::Radius& shaft_radius) {
  if (answer.mode == ContactArray::STATIC || answer.topology != topology_) {
    was_inside_.reset();
    depths_.clear();
  }
  topology_ = answer.topology;

  const bool inside = enabled_ && is_inside(answer);
  std::vector<Push> pushes =
      sides_.follow(answer, shaft_radius,
                    was_inside_.value_or(inside) ? depths_inside(answer, shaft_radius)
                                                 : KeptSides::DepthsInside());
  was_inside_ = inside;
  if (!inside && answer.contacts.empty()) depths_.clear();
  keep_depths(answer, pushes);
  if (inside && std::none_of(pushes.begin(), pushes.end(), is_pushing)) {
    pushes.push_back(push_out(answer, shaft_radius));
  }
  return pushes;
}

}  // namespace organ_collision
