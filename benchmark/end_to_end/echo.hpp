#pragma once

#include <organ_collision/ContactArray.h>
#include <organ_collision/OrganVertices.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <cstddef>

namespace organ_collision::bench {

/// Stands in for the node, to measure how long the messages alone take. It answers each shape at
/// once with one empty ContactArray for each tool. Like the nodelet, it answers in its own thread.
class Echo {
 public:
  explicit Echo(std::size_t tools);

 private:
  void answer(const OrganVerticesConstPtr& shape);

  std::size_t tools_;
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::Publisher contacts_;
  ros::Subscriber vertices_;
  ros::AsyncSpinner spinner_{1, &queue_};
};

}  // namespace organ_collision::bench
