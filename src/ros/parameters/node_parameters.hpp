#pragma once

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <string>
#include <vector>

#include "picking/pickers/picker.hpp"
#include "ros/interface/parameter_group.hpp"

namespace organ_collision {

/// A tool: a shaft whose axis runs from the origin of one frame to the origin of another, links of
/// a robot, or both.
struct ToolParameters {
  std::string name;
  std::string trocar_frame;  ///< empty: no shaft
  std::string tip_frame;     ///< of links alone: the frame that tip_pose_topic places, or empty
  double radius = 0.0;       ///< [m] of the shaft; 0: no shaft
  std::string tip_pose_topic = {};      ///< PoseStamped that places tip_frame; empty: TF does
  std::string base_pose_topic = {};     ///< the same for the frame of those poses
  std::vector<std::string> links = {};  ///< of the robot's URDF, each once; empty: a shaft alone
  std::string robot_description = {};   ///< parameter that holds the URDF; where `urdf` is empty
  std::string urdf = {};                ///< file or URL of the URDF
  std::string tf_prefix = {};           ///< before the links' names in TF, as PREFIX/LINK

  bool has_shaft() const { return radius > 0.0; }
  /// The TF frame of a link.
  std::string link_frame(const std::string& link) const;
};

/// The node's parameters, as validated; the defaults are the documented ones.
struct NodeParameters {
  std::vector<ToolParameters> tools;
  PickerKind picker = PickerKind::kFeedback;
  double rate_hz = 0.0;      ///< 0: evaluated on each mesh only
  bool organ_motion = true;  ///< organs move linearly from shape to shape; else they jump
  double motion_sample_sec = 0.001;
  int motion_samples_max = 100;
  double tf_timeout_sec = 0.02;
  double mesh_timeout_sec = 0.0;  ///< 0: never stale
  int max_faces = 2'000'000;
  int max_batch = 1000;            ///< motions of a batch
  int max_batch_bytes = 64 << 20;  ///< [bytes] of the results of a batch, as ROS sends them
  bool publish_regions = false;
  double diagnostic_period_sec = 1.0;  ///< of wall time
};

/// Parameters, and one sentence for each name that the node does not know.
struct LoadedParameters {
  NodeParameters parameters;
  std::vector<std::string> misspelt;
};

/// Reads the members of the node's private namespace. Throws ParameterError.
LoadedParameters parse_parameters(const XmlRpc::XmlRpcValue& private_namespace);

/// The same from the parameter server.
LoadedParameters load_parameters(const ros::NodeHandle& private_node);

}  // namespace organ_collision
