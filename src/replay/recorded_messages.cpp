#include "recorded_messages.hpp"

#include <algorithm>
#include <memory>
#include <tuple>

namespace organ_collision {

RecordedMessages::RecordedMessages(
    const rosbag::Bag& bag, const std::function<bool(const rosbag::ConnectionInfo&)>& is_wanted)
    : View(bag, [is_wanted](
                    const rosbag::ConnectionInfo* connection) { return is_wanted(*connection); }),
      bag_(bag) {
  for (const rosbag::MessageRange* range : ranges_) {
    for (auto entry = range->begin; entry != range->end; ++entry) {
      places_.push_back({*entry, range->connection_info});
    }
  }
  // A bag is written from its beginning to its end.
  std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) {
    return std::tie(a.entry.chunk_pos, a.entry.offset) <
           std::tie(b.entry.chunk_pos, b.entry.offset);
  });
}

void RecordedMessages::for_each(const std::function<void(const rosbag::MessageInstance&)>& take) {
  for (const Place& place : places_) {
    const std::unique_ptr<rosbag::MessageInstance> message(
        newMessageInstance(place.connection, place.entry, bag_));
    take(*message);
  }
}

}  // namespace organ_collision
