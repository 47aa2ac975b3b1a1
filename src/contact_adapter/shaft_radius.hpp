#pragma once

#include <organ_collision/ContactArray.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <cstdint>
#include <optional>
#include <string>

namespace organ_collision {

/// [m] The radius of a tool's shaft, from the collision node's parameter `tools`. std::nullopt if
/// the parameter does not contain the tool, or if the tool has no shaft.
std::optional<double> shaft_radius(const XmlRpc::XmlRpcValue& tools, const std::string& tool);

/// Whether this link of the answer's tool is its shaft.
bool is_shaft(std::uint32_t link, const ContactArray& answer);

/// [m] `shaft_radius` if the contact is of the shaft; std::nullopt if it is of a link.
std::optional<double> radius_at(const Contact& contact, const ContactArray& answer,
                                const std::optional<double>& shaft_radius);

}  // namespace organ_collision
