#pragma once

#include <ros/serialization.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace organ_collision {

/// Reads a message of roscpp from bytes of a peer that may be wrong. ros::serialization::IStream
/// makes room for as many elements as a list claims to have, before it looks whether the bytes are
/// there: a message of 50 bytes can take 16 GB. This stream looks first. What it reads needs at
/// most about ten times the memory of the bytes.
class CheckedStream : public ros::serialization::Stream {
 public:
  // roscpp asks for this name. NOLINTNEXTLINE(readability-identifier-naming)
  static constexpr ros::serialization::StreamType stream_type =
      ros::serialization::stream_types::Input;

  /// Only reads the bytes, which must outlive this.
  CheckedStream(const std::uint8_t* bytes, std::uint32_t size)
      : Stream(const_cast<std::uint8_t*>(bytes), size) {}

  /// Throws ros::serialization::StreamOverrunException if the bytes end before the value does.
  template <typename Value>
  void next(Value& value) {
    ros::serialization::deserialize(*this, value);
  }
  template <typename Element, typename Allocator>
  void next(std::vector<Element, Allocator>& list) {
    check_count(ros::serialization::serializationLength(Element()));
    ros::serialization::deserialize(*this, list);
  }

 private:
  /// `least`: bytes of the shortest element.
  void check_count(std::uint32_t least) {
    std::uint32_t count = 0;
    if (getLength() < sizeof count) return;  // deserialize() refuses it.
    std::memcpy(&count, getData(), sizeof count);
    const std::uint64_t there = getLength() - sizeof count;
    if (std::uint64_t{count} * least <= there) return;
    throw ros::serialization::StreamOverrunException(
        "a list claims " + std::to_string(count) + " elements of at least " +
        std::to_string(least) + " bytes, but only " + std::to_string(there) + " bytes follow");
  }
};

}  // namespace organ_collision
