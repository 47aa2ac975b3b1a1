#pragma once

#include <ros/node_handle.h>
#include <visualization_msgs/MarkerArray.h>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "ros/steps/step_history.hpp"

namespace organ_collision {

/// The topic of a node's markers, and the thread of lower priority that draws them. The node's
/// thread decides when a picture is due, and hands over what it shows.
///
/// Only one thread may call these functions: the node's.
class MarkerTopic {
 public:
  using Publish = std::function<void(const visualization_msgs::MarkerArrayConstPtr&)>;
  /// Draws one picture, in the other thread. It must own what it shows.
  using Picture = std::function<void(const Publish&)>;

  explicit MarkerTopic(ros::NodeHandle private_node);
  ~MarkerTopic();

  bool has_subscribers() const { return subscribers_ > 0; }
  /// Whether draw() is to be called: somebody looks, the last picture is finished, and 1 /
  /// `rate_hz` has passed since it was due. If the rate is 0, an empty picture is due now and then.
  bool is_due(double rate_hz, SteadyTime now);
  /// The next picture is due as soon as the last one is finished.
  void hurry() { due_ = {}; }
  /// Whether there is a subscriber that knows nothing yet. Forgets it.
  bool take_anew();
  /// Hands a picture that is due to the other thread. If it throws, it is left out.
  void draw(Picture picture);

 private:
  void draw_pictures();
  Picture next_picture();
  void publish(const visualization_msgs::MarkerArrayConstPtr& array);

  int subscribers_ = 0;
  bool anew_ = false;
  SteadyTime due_;

  // Shared with the drawing thread.
  std::mutex mutex_;
  std::condition_variable changed_;
  Picture picture_;  ///< to be drawn
  bool drawing_ = false;
  bool stop_ = false;

  ros::Publisher markers_;
  std::thread thread_;
};

}  // namespace organ_collision
