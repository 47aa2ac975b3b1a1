#pragma once

#include <organ_collision/ContactArray.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <optional>
#include <string>

namespace organ_collision {

/// [m] The radius of a tool's shaft, as the collision node's parameter `tools` has it; none where
/// the tool is not in it, or has no shaft.
std::optional<double> shaft_radius(const XmlRpc::XmlRpcValue& tools, const std::string& tool);

/// The shaft's radius where the contact is one of the shaft; none where it is one of a link.
std::optional<double> radius_at(const Contact& contact, const ContactArray& answer,
                                const std::optional<double>& shaft_radius);

}  // namespace organ_collision
