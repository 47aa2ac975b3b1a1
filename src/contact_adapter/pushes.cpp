#include "pushes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/messages/conversions.hpp"
#include "common/messages/failure_log.hpp"
#include "geometry/concatenate.hpp"
#include "haptics/basins.hpp"

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

bool is_tool_inside(const ContactArray& answer) {
  const ToolPlacement& placement = answer.placement;
  if (answer.clearance.state == Clearance::NOT_ASKED) return false;
  if (placement.tip != ToolPlacement::INSIDE || !placement.crossings.empty()) return false;
  const bool is_shaft = answer.links.empty();
  // Where the side of the tip is known, that of the trocar is unknown only if there is no shaft.
  const bool is_unknown = placement.trocar == ToolPlacement::UNKNOWN;
  if (is_unknown ? is_shaft : placement.trocar != ToolPlacement::INSIDE) return false;
  return is_shaft || answer.contacts.empty();
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

PushTracker::Side PushTracker::Side::first_touch(const Contact& contact,
                                                 const ShaftRadius& radius) {
  Side side;
  side.normal = to_eigen(contact.normal);
  side.depth = contact.depth;
  side.depth_in_plane = radius.value_or(contact.depth);
  // The face may have been pierced before this step. Then assume that the tip pierced it.
  side.by_tip = contact.shaft >= 1.0 || contact.fraction == 0.0;
  if (!radius) return side;
  side.is_past = contact.depth >= *radius;
  if (!side.is_past) side.behind = contact.behind != 0;
  return side;
}

PushTracker::Side PushTracker::Side::first_touch_from_inside(const Contact& contact,
                                                             double depth_inside) {
  Side side;
  side.normal = -to_eigen(contact.normal);
  side.depth_in_plane = 0.5 * depth_inside;
  side.depth = depth_inside - contact.depth;
  side.behind = false;
  side.is_past = contact.depth <= side.depth_in_plane;
  return side;
}

/// Follows the next contact of a link, or of a shaft of unknown radius.
void PushTracker::Side::move_on(const Contact& contact) {
  const Vector3d now = to_eigen(contact.normal);
  const bool was_past = is_past;
  is_past = now.dot(normal) < 0.0;
  if (!is_past) {
    normal = now;
    depth = contact.depth;
    return;
  }
  // The depth continues from its last value.
  if (!was_past) depth_in_plane = 0.5 * (depth + contact.depth);
  const double distance = depth_in_plane - contact.depth;
  depth = depth_in_plane - distance * normal.dot(now);
}

void PushTracker::Side::move_on(const Contact& contact, double radius) {
  const Vector3d now = to_eigen(contact.normal);
  const double distance = radius - contact.depth;
  if (distance <= 0.0) {  // The axis pierces the face, or passed it during the step.
    is_past = true;
    if (by_tip && now.dot(normal) >= kSameSide) depth_in_plane = contact.depth;
    depth = depth_in_plane;
    return;
  }
  const bool is_behind = contact.behind != 0;
  if (!behind) behind = (now.dot(normal) > 0.0) == is_behind;
  is_past = is_behind != *behind;
  if (!is_past) {
    normal = turned(normal, now, greatest_angle(distance, radius));
    by_tip = contact.shaft >= 1.0;
    depth_in_plane = radius;
  } else if (!is_nearest) {
    // The face becomes nearest when the axis is already past the surface, for example beside an
    // edge. The depth continues from its last value, so that the force does not jump.
    depth_in_plane = std::min(depth_in_plane, depth + distance * normal.dot(now));
  }
  depth = depth_in_plane - distance * normal.dot(now);
}

/// The kept side of the contact's face. Null if the last answer did not touch this face.
const PushTracker::Side* PushTracker::find(const Contact& contact) const {
  const auto side = sides_.find({contact.face, contact.link});
  return side == sides_.end() ? nullptr : &side->second;
}

PushTracker::Side PushTracker::side_now(const Contact& contact, const ShaftRadius& shaft_radius,
                                        bool began_inside) const {
  const ShaftRadius radius = radius_at(contact, shaft_radius);
  if (const Side* before = find(contact)) {
    Side side = *before;
    radius ? side.move_on(contact, *radius) : side.move_on(contact);
    return side;
  }
  if (!began_inside) return Side::first_touch(contact, radius);
  return Side::first_touch_from_inside(contact, depth_inside(contact.link, shaft_radius));
}

/// Keeps the sides of the answer's faces. Returns the pushes of its contacts.
std::vector<Push> PushTracker::keep_sides(const ContactArray& answer,
                                          const ShaftRadius& shaft_radius, bool began_inside) {
  const std::vector<Contact>& contacts = answer.contacts;
  const std::vector<std::size_t> basins = basins_of(contacts);
  std::vector<Side> nearest(contacts.size());
  std::vector<bool> passed(contacts.size());  // past the face when the step begins or ends
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (basins[i] != i) continue;
    const Side* before = find(contacts[i]);
    nearest[i] = side_now(contacts[i], shaft_radius, began_inside);
    nearest[i].is_nearest = true;
    passed[i] = nearest[i].is_past || (before && before->is_past);
  }

  std::map<FaceAndLink, Side> sides;
  std::vector<Push> pushes;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    const Side& there = nearest[basins[i]];
    Push push{to_eigen(contact.on_organ), there.normal, there.depth, basins[i] == i};
    if (!push.counts) push.depth = std::min(there.depth, contact.depth);
    // Faces around the nearest one share its side. Faces of another side keep their own side: past
    // a crease, where the edge of the crease is nearest, both sides keep pushing.
    const Side* own = push.counts ? nullptr : find(contact);
    if (own && own->normal.dot(there.normal) >= kSameSide) own = nullptr;
    if (own) {
      const ShaftRadius radius = radius_at(contact, shaft_radius);
      push.normal = own->normal;
      push.counts = radius && passed[basins[i]];
      if (push.counts) push.depth = depth_of_side(contact, own->normal, *radius);
    }
    Side& now = sides[{contact.face, contact.link}];
    now = own ? *own : there;
    now.is_nearest = basins[i] == i;
    pushes.push_back(push);
  }
  sides_ = std::move(sides);
  return pushes;
}

/// [m] The depth with which a link is pushed when it is wholly inside, just below the surface.
double PushTracker::depth_inside(std::int32_t link, const ShaftRadius& shaft_radius) const {
  if (shaft_radius && link == kShaftLink) return 2.0 * *shaft_radius;
  const auto known = depths_.find(link);
  return known == depths_.end() ? 0.0 : known->second;
}

void PushTracker::keep_depths(const ContactArray& answer, const std::vector<Push>& pushes) {
  for (const Contact& contact : answer.contacts) depths_[contact.link] = 0.0;
  for (std::size_t i = 0; i < answer.contacts.size(); ++i) {
    double& depth = depths_[answer.contacts[i].link];
    if (is_pushing(pushes[i])) depth = std::max(depth, pushes[i].depth);
  }
}

Push PushTracker::push_out(const ContactArray& answer, const ShaftRadius& shaft_radius) const {
  const Clearance& clearance = answer.clearance;
  refuse_unknown_way(clearance);
  return {to_eigen(clearance.on_organ), -to_eigen(clearance.normal),
          clearance.distance + depth_inside(clearance.link, shaft_radius), true};
}

std::vector<Push> PushTracker::follow(const ContactArray& answer, const ShaftRadius& shaft_radius) {
  const bool is_inside = pushes_out_ && is_tool_inside(answer);
  const bool began_inside = was_inside_.value_or(is_inside);
  std::vector<Push> pushes = keep_sides(answer, shaft_radius, began_inside);
  was_inside_ = is_inside;
  if (!is_inside && answer.contacts.empty()) depths_.clear();
  keep_depths(answer, pushes);
  if (is_inside && std::none_of(pushes.begin(), pushes.end(), is_pushing)) {
    pushes.push_back(push_out(answer, shaft_radius));
  }
  return pushes;
}

}  // namespace organ_collision
