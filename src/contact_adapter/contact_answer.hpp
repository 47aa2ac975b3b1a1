#pragma once

#include <organ_collision/ContactArray.h>
#include <std_msgs/UInt32MultiArray.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <cstdint>
#include <optional>
#include <string>

namespace organ_collision {

/// Contact.link and Clearance.link of a tool's shaft.
inline constexpr std::int32_t kShaftLink = -1;

/// Whether the contacts have points, normals and depths. In the paper's modes, they do not.
bool has_geometry(const ContactArray& contacts);

/// Checks an answer whose status is OK. Throws Rejection, with the illegal value, for
/// - unresolved contacts;
/// - an unknown mode, an empty frame, or an illegal name;
/// - a number of regions other than zero or the number of contacts;
/// - contacts with geometry: a link that the tool does not have, a value of `depth`, `point` or
///   `on_organ` that is not finite, or a normal whose length is not 1 (to 1e-6);
/// - a known clearance of such a link, whose distance or `on_organ` is not finite, or whose normal
///   is not unit.
/// Of these, the collision node itself sends only unresolved contacts.
void check_contacts(const ContactArray& contacts);

/// The numbers of the touched faces, each once, in rising order. The one dimension of the array is
/// called "faces".
std_msgs::UInt32MultiArray face_list(const ContactArray& contacts);

/// Why the force of an answer without contacts may be missing: it is not known whether the tool is
/// inside the organ, or where it would come out. Empty if both are known, or if something is
/// touched.
std::string doubt_about_side(const ContactArray& contacts);

/// [m] The radius of a tool's shaft. Unset if it is not known, or if the tool has no shaft.
using ShaftRadius = std::optional<double>;

/// The radius of this tool in the collision node's parameter `tools`.
ShaftRadius shaft_radius(const XmlRpc::XmlRpcValue& tools, const std::string& tool);

/// `shaft_radius` if the contact is of the shaft; unset if it is of a link.
ShaftRadius radius_at(const Contact& contact, const ShaftRadius& shaft_radius);

}  // namespace organ_collision
