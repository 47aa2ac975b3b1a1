#pragma once

#include <organ_collision/ContactArray.h>
#include <ros/node_handle.h>

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>

#include "script.hpp"

namespace organ_collision::soak {

/// How far the node is behind the simulator. If it is so far behind that its queues of poses would
/// overflow, poses would be lost without a word, as roscpp does it, and the judge could not know
/// the paths of the tools. The simulator waits then.
class Lag {
 public:
  Lag();

  /// Notes that a tick was sent.
  void add(Tick tick);
  /// In ticks, however the clock has jumped.
  std::uint64_t ticks() const;

 private:
  void take(const ContactArray& answer);

  mutable std::mutex mutex_;
  std::map<Tick, std::uint64_t> sent_;  ///< by tick: the number of ticks sent up to it
  std::uint64_t count_ = 0, answered_ = 0;
  ros::NodeHandle node_;
  ros::Subscriber contacts_;
};

}  // namespace organ_collision::soak
