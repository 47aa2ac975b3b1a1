#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <cstddef>

#include "test/rostest/load/sheet.hpp"

namespace organ_collision::stress {

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

}  // namespace organ_collision::stress
