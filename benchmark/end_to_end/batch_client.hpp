#pragma once

#include <organ_collision/QueryCollisionBatch.h>
#include <ros/node_handle.h>

#include <cstddef>
#include <string>

#include "benchmark/scenes/motion_set.hpp"

namespace organ_collision::bench {

/// Asks the node `organ_collision` of its own namespace about batches of motions against the
/// Simulator's organ. The motions are those of a MotionSet, again and again.
class BatchClient {
 public:
  /// `tool`: as for motions_of(). The grasper is the node's tool of that name.
  BatchClient(std::size_t faces, const std::string& tool);

  /// Publishes the organ, for a node that has no simulator, and waits until the node has it. Throws
  /// std::runtime_error if that takes more than half a minute.
  void publish_organ();

  struct Report {
    std::size_t motions = 0;
    std::size_t contacts = 0;
    std::size_t failed = 0;  ///< motions without a good answer
    double seconds = 0.0;    ///< from the first request to the last answer
  };
  /// Asks for batches of `count` motions, one after the other, until `seconds` have passed.
  /// `mode` is a mode of ContactArray. Throws std::runtime_error if the node refuses.
  Report ask(std::uint8_t mode, std::size_t count, double seconds);

 private:
  void set_request(std::uint8_t mode, std::size_t count);

  OrganSurface organ_;
  std::string tool_;
  MotionSet motions_;
  QueryCollisionBatch batch_;
  ros::NodeHandle node_;
  ros::Publisher mesh_;
  ros::ServiceClient client_;
};

}  // namespace organ_collision::bench
