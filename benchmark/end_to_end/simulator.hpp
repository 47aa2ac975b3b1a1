#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <organ_collision/ContactArray.h>
#include <organ_collision/OrganVertices.h>
#include <organ_collision/QueryCollision.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <boost/shared_ptr.hpp>
#include <string>
#include <unordered_map>
#include <vector>

#include "benchmark/scenes/organ_surface.hpp"
#include "benchmark/scenes/tool_motions.hpp"
#include "latency_report.hpp"

namespace organ_collision::bench {

/// A simulator without physics. It publishes a deforming organ and the poses of tools that pierce
/// it to the node `organ_collision` of its own namespace, which has the tools `tool0`, `tool1` ...
class Simulator {
 public:
  Simulator(std::size_t faces, std::size_t tools);

  /// Returns when the node has evaluated a shape of the organ with every tool. Throws
  /// std::runtime_error if that takes more than half a minute.
  void start();
  /// Publishes shapes at `rate` [Hz] for `seconds`, whether or not answers arrive.
  LatencyReport run(double rate, double seconds);
  /// Asks static queries for `seconds`, one after the other, over one persistent connection.
  LatencyReport ask(double seconds);

 private:
  struct Sent {
    ros::SteadyTime time;
    std::size_t answers;
  };

  void send_poses(ros::Time stamp);
  boost::shared_ptr<OrganVertices> next_shape(ros::Time stamp);
  void on_contacts(const ContactArrayConstPtr& contacts);
  void on_diagnostics(const diagnostic_msgs::DiagnosticArrayConstPtr& diagnostics);

  OrganSurface organ_;
  std::vector<std::vector<float>> shapes_;
  std::vector<ShaftMotion> tools_;
  double radius_;
  std::size_t step_ = 0;
  std::vector<boost::shared_ptr<OrganVertices>> messages_;
  std::unordered_map<std::uint64_t, Sent> waiting_;
  LatencyReport* report_ = nullptr;
  double query_sec_ = 0.0;  ///< [s] the node's median time of a query

  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::Publisher mesh_, vertices_;
  ros::Subscriber contacts_, diagnostics_;
  tf2_ros::TransformBroadcaster transforms_;
  tf2_ros::StaticTransformBroadcaster static_transforms_;
};

}  // namespace organ_collision::bench
