#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/time.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <thread>

#include "load.hpp"

namespace organ_collision::stress {

/// Sends the poses of the tools of stress.test: by TF those of "probe", "needle" and "jaw", by
/// messages those of "stylus". They go up and down through the sheets.
class MovingTools {
 public:
  MovingTools();

  /// Sends one pose of each tool, with the time of now.
  void send();

 private:
  ros::NodeHandle node_;
  ros::Publisher stylus_;
  tf2_ros::StaticTransformBroadcaster static_transforms_;
  tf2_ros::TransformBroadcaster transforms_;
  double phase_ = 0.0;  ///< [rad]
};

/// Sends organs to the node. Each function is for a thread of its own.
class OrganTraffic {
 public:
  OrganTraffic();

  /// A new shape of the organ "quick".
  void move_quick();
  /// The organ "large", of 100 352 faces, appears, is moved, is cut, or vanishes.
  void change_large();
  /// One of several organs appears, and another one vanishes.
  void change_brief();
  /// Sends the mesh of "quick" again, because the node may have lost it.
  void restore_quick();

 private:
  ros::NodeHandle node_;
  ros::Publisher meshes_, vertices_;
  std::size_t large_step_ = 0, brief_step_ = 0;
  double quick_phase_ = 0.0;
};

/// Does the same again and again in a thread of its own, until it is destroyed.
class Repeated {
 public:
  /// Waits for `pause` [s of wall time] after each time.
  Repeated(double pause, std::function<void()> once);
  ~Repeated();

 private:
  void work(double pause) const;

  const std::function<void()> once_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

/// Publishes /clock, which runs as fast as real time and can jump backwards.
class SimulatedClock {
 public:
  SimulatedClock();

  /// Sets the clock back, as a simulator does that is reset.
  void jump_back() { jumps_ = true; }

 private:
  void publish();

  ros::NodeHandle node_;
  ros::Publisher clock_;
  std::atomic<bool> jumps_ = false;
  ros::Time now_{100.0};
  ros::WallTime last_ = ros::WallTime::now();
  std::optional<Repeated> ticks_;
};

}  // namespace organ_collision::stress
