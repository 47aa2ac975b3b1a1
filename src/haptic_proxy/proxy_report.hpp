#pragma once

#include <geometry_msgs/Pose.h>
#include <ros/time.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "organ_collision/query/haptic_proxy.hpp"
#include "proxy_forces.hpp"
#include "proxy_scene.hpp"
#include "ros/parameters/tool_parameters.hpp"

namespace organ_collision {

/// What is published about a tool at one moment.
struct ProxyReport {
  const ToolParameters& tool;
  std::string frame;    ///< the proxy's; empty: not known yet
  ros::Time stamp;      ///< of the hand's pose; now if there is no answer, or if the pose has none
  std::uint8_t status;  ///< ContactArray's: OK, or why there is no answer
  std::string message;  ///< why there is no answer, or why the proxy was placed anew
  const ProxyAnswer* answer;         ///< null: there is no answer
  const ProxyScene* scene;           ///< of the answer
  std::optional<ToolPose> hand;      ///< the last one that had an answer
  std::optional<ToolPose> proxy;     ///< the last one
  std::vector<OrganForce> forces{};  ///< as they are published: limited, and faded in or out
  /// The parameter whose limit reduced the forces. Null: they are whole.
  const char* clipped_by = nullptr;
  double tick_sec = 0.0;  ///< [s] that the tick took in the core
};

/// The pose of the tip of a shaft, with the z axis along the shaft, from trocar to tip; or of the
/// first link of a tool without a shaft.
geometry_msgs::Pose pose_of(const ToolParameters& tool, const ToolPose& pose);

}  // namespace organ_collision
