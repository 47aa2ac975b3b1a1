#pragma once

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
#include "benchmark/scenes/surgeon.hpp"
#include "latency.hpp"

namespace organ_collision::bench {

/// How long an answer took, and how many never came.
struct LatencyReport {
  double rate;  ///< [Hz] at which shapes were published; 0: one after the other
  std::size_t sent = 0;
  std::size_t skipped = 0;  ///< shapes without contacts of all tools
  std::size_t failed = 0;   ///< answers with another status than OK
  bool late = false;        ///< shapes could not even be sent at that rate
  Latencies latencies;      ///< from publishing a shape to the contacts of the last tool
};

/// A simulator that does nothing but publish: a deforming organ, and tools that pierce it. The node
/// that it talks to is `/organ_collision`, with tools `tool0`, `tool1` ...
class Simulator {
 public:
  Simulator(std::size_t faces, std::size_t tools);

  /// Returns when the node has evaluated the organ's first shape with every tool. Throws
  /// std::runtime_error when it does not within half a minute.
  void start();
  /// Publishes shapes at `rate` for `seconds`, whether or not answers come.
  LatencyReport run(double rate, double seconds);
  /// Asks static queries over one connection, one after the other.
  LatencyReport ask(double seconds);

 private:
  struct Sent {
    ros::SteadyTime time;
    std::size_t answers;
  };

  void send_poses(ros::Time stamp);
  boost::shared_ptr<OrganVertices> next_shape(ros::Time stamp);
  void on_contacts(const ContactArrayConstPtr& contacts);
  void answer_until(ros::Time time);

  OrganSurface organ_;
  std::vector<std::vector<float>> shapes_;
  std::vector<ShaftMotion> tools_;
  double radius_;
  std::size_t step_ = 0;
  std::vector<boost::shared_ptr<OrganVertices>> messages_;
  std::unordered_map<std::uint64_t, Sent> waiting_;
  LatencyReport* report_ = nullptr;

  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::Publisher mesh_, vertices_;
  ros::Subscriber contacts_;
  tf2_ros::TransformBroadcaster transforms_;
  tf2_ros::StaticTransformBroadcaster static_transforms_;
};

}  // namespace organ_collision::bench
