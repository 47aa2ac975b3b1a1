#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <optional>
#include <string>

namespace organ_collision {

/// [m] The radius of a tool's shaft, as the collision node's parameter `tools` has it; none where
/// the tool is not in it, or has no shaft.
std::optional<double> shaft_radius(const XmlRpc::XmlRpcValue& tools, const std::string& tool);

}  // namespace organ_collision
