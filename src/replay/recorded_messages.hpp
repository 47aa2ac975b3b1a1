#pragma once

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <cstddef>
#include <functional>
#include <vector>

namespace organ_collision {

/// The messages of a bag in the order in which they were recorded. rosbag::View alone orders them
/// by time: messages of the same simulated time would lose their order, and a clock that jumped
/// back would mix the times before and after the jump.
class RecordedMessages : private rosbag::View {
 public:
  /// Those of the connections for which `is_wanted` returns true. `bag` must outlive this.
  RecordedMessages(const rosbag::Bag& bag,
                   const std::function<bool(const rosbag::ConnectionInfo&)>& is_wanted);

  std::size_t size() const { return places_.size(); }
  /// Calls `take` for each message. Throws what rosbag throws if the bag cannot be read.
  void for_each(const std::function<void(const rosbag::MessageInstance&)>& take);

 private:
  struct Place {
    rosbag::IndexEntry entry;
    const rosbag::ConnectionInfo* connection;
  };

  const rosbag::Bag& bag_;
  std::vector<Place> places_;
};

}  // namespace organ_collision
