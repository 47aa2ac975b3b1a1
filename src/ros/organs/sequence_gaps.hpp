#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace organ_collision {

/// Finds out which messages of a topic were lost before they came, by the sequence numbers that
/// publishers write into headers. roscpp and rospy number the messages of a topic one after
/// another.
class SequenceGaps {
 public:
  /// Notes a message. Returns how many of the same publisher are missing between the last one and
  /// this. A number that is not above the last one is of a publisher that started again.
  std::uint64_t add(const std::string& publisher, std::uint32_t number);

 private:
  std::map<std::string, std::uint32_t> last_;
};

}  // namespace organ_collision
