#include "pushes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "basins.hpp"
#include "contact_answer.hpp"
#include "geometry/concatenate.hpp"
#include "ros/messages/conversions.hpp"
#include "ros/messages/failure_log.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// [1] Cosine of the largest angle between kept normals of the same side. Normals that differ more
/// belong to two sides, for example of a crease.
constexpr double kSameSide = 0.9;

/// [rad] The largest angle allowed between the kept normal and the contact's normal, when the axis
/// is at `distance` [m] from the face. The nearer the axis comes to an edge, the faster the
/// direction to the edge turns. Below half the radius, the kept normal follows this direction less
/// and less, so that the force turns no faster than the tool moves.
double greatest_angle(double distance, double radius) {
  return M_PI * std::max(0.0, 1.0 - 2.0 * distance / radius);
}

/// `kept`, rotated towards `now` until the angle between them is at most `angle` [rad]. Both are
/// unit vectors.
Vector3d turned(const Vector3d& kept, const Vector3d& now, double angle) {
  const double between = std::atan2(kept.cross(now).norm(), kept.dot(now));
  if (between <= angle) return kept;
  const Vector3d across = kept - kept.dot(now) * now;
  if (angle == 0.0 || across.isZero(0.0)) return now;
  return std::cos(angle) * now + std::sin(angle) * across.normalized();
}

/// [m] The depth with which a side pushes after it has stopped being the nearest one. It starts at
/// the contact's own depth. It decreases as the contact's normal turns away from the side, and
/// decreases faster the farther the axis is from the face.
double depth_of_side(const Contact& contact, const Vector3d& side, double radius) {
  const double distance = std::clamp(radius - contact.depth, 0.0, radius);
  const double turned_away = 1.0 - side.dot(to_eigen(contact.normal));
  return (radius - distance) * std::max(0.0, 1.0 - distance / radius * turned_away);
}

}  // namespace

const KeptSides::Kept* KeptSides::find(const Contact& contact) const {
  const auto kept = kept_.find({contact.face, contact.link});
  return kept == kept_.end() ? nullptr : &kept->second;
}

KeptSides::Kept KeptSides::first_touch(const Contact& contact, const Radius& radius) {
  Kept kept;
  kept.normal = to_eigen(contact.normal);
  kept.depth = contact.depth;
  kept.depth_in_plane = radius.value_or(contact.depth);
  // The face may have been pierced before this step. Then assume that the tip pierced it.
  kept.by_tip = contact.shaft >= 1.0 || contact.fraction == 0.0;
  if (!radius) return kept;
  kept.is_past = contact.depth >= *radius;
  if (!kept.is_past) kept.behind = contact.behind != 0;
  return kept;
}

KeptSides::Kept KeptSides::first_touch_from_inside(const Contact& contact, double depth_inside) {
  Kept kept;
  kept.normal = -to_eigen(contact.normal);
  kept.depth_in_plane = 0.5 * depth_inside;
  kept.depth = depth_inside - contact.depth;
  kept.behind = false;
  kept.is_past = contact.depth <= kept.depth_in_plane;
  return kept;
}

void KeptSides::move_on(const Contact& contact, Kept& kept) {
  const Vector3d now = to_eigen(contact.normal);
  const bool was_past = kept.is_past;
  kept.is_past = now.dot(kept.normal) < 0.0;
  if (kept.is_past) {
    // The depth continues from its last value.
    if (!was_past) kept.depth_in_plane = 0.5 * (kept.depth + contact.depth);
    const double distance = kept.depth_in_plane - contact.depth;
    kept.depth = kept.depth_in_plane - distance * kept.normal.dot(now);
  } else {
    kept.normal = now;
    kept.depth = contact.depth;
  }
}

void KeptSides::move_on(const Contact& contact, double radius, Kept& kept) {
  const Vector3d now = to_eigen(contact.normal);
  const double distance = radius - contact.depth;
  if (distance <= 0.0) {  // The axis pierces the face, or passed it during the step.
    kept.is_past = true;
    if (kept.by_tip && now.dot(kept.normal) >= kSameSide) kept.depth_in_plane = contact.depth;
    kept.depth = kept.depth_in_plane;
    return;
  }
  const bool behind = contact.behind != 0;
  if (!kept.behind) kept.behind = (now.dot(kept.normal) > 0.0) == behind;
  kept.is_past = behind != *kept.behind;
  if (!kept.is_past) {
    kept.normal = turned(kept.normal, now, greatest_angle(distance, radius));
    kept.by_tip = contact.shaft >= 1.0;
    kept.depth_in_plane = radius;
  } else if (!kept.is_nearest) {
    // The face becomes nearest when the axis is already past the surface, for example beside an
    // edge. The depth continues from its last value, so that the force does not jump.
    kept.depth_in_plane =
        std::min(kept.depth_in_plane, kept.depth + distance * kept.normal.dot(now));
  }
  kept.depth = kept.depth_in_plane - distance * kept.normal.dot(now);
}

KeptSides::Kept KeptSides::kept_now(const Contact& contact, const Radius& radius,
                                    const DepthsInside& inside) const {
  const Kept* before = find(contact);
  if (!before) {
    const auto depth = inside.find(contact.link);
    return depth == inside.end() ? first_touch(contact, radius)
                                 : first_touch_from_inside(contact, depth->second);
  }
  Kept kept = *before;
  if (radius) {
    move_on(contact, *radius, kept);
  } else {
    move_on(contact, kept);
  }
  return kept;
}

std::vector<Push> KeptSides::follow(const ContactArray& answer, const Radius& shaft_radius,
                                    const DepthsInside& inside) {
  if (answer.mode == ContactArray::STATIC || answer.topology != topology_) kept_.clear();
  topology_ = answer.topology;

  const std::vector<Contact>& contacts = answer.contacts;
  const std::vector<std::size_t> basins = basins_of(contacts);
  std::vector<Kept> nearest(contacts.size());
  std::vector<bool> passed(contacts.size());  // past the face when the step begins or ends
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (basins[i] != i) continue;
    const Kept* before = find(contacts[i]);
    nearest[i] = kept_now(contacts[i], radius_at(contacts[i], answer, shaft_radius), inside);
    nearest[i].is_nearest = true;
    passed[i] = nearest[i].is_past || (before && before->is_past);
  }

  std::map<FaceAndLink, Kept> kept;
  std::vector<Push> pushes;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    const Kept& there = nearest[basins[i]];
    Push push{to_eigen(contact.end_point), there.normal, there.depth, basins[i] == i};
    if (!push.counts) push.depth = std::min(there.depth, contact.depth);
    // Faces around the nearest one share its side. Faces of another side keep their own side: past
    // a crease, where the edge of the crease is nearest, both sides keep pushing.
    const Kept* own = push.counts ? nullptr : find(contact);
    if (own && own->normal.dot(there.normal) >= kSameSide) own = nullptr;
    if (own) {
      const Radius radius = radius_at(contact, answer, shaft_radius);
      push.normal = own->normal;
      push.counts = radius && passed[basins[i]];
      if (push.counts) push.depth = depth_of_side(contact, own->normal, *radius);
    }
    Kept& now = kept[{contact.face, contact.link}];
    now = own ? *own : there;
    now.is_nearest = basins[i] == i;
    pushes.push_back(push);
  }
  kept_ = std::move(kept);
  return pushes;
}

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
