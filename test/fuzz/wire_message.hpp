#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "fuzz_input.hpp"
#include "ros/interface/checked_stream.hpp"

namespace organ_collision {

/// The next message of an input as it comes over the wire: its size in two bytes, and its bytes. It
/// is read as the nodes read messages. std::nullopt if the bytes are no such message.
template <typename Message>
std::optional<Message> next_message(FuzzInput& input) {
  const std::string bytes = input.sized_text();
  Message message;
  try {
    CheckedStream(reinterpret_cast<const std::uint8_t*>(bytes.data()),
                  static_cast<std::uint32_t>(bytes.size()))
        .next(message);
  } catch (const ros::serialization::StreamOverrunException&) {
    return std::nullopt;
  }
  return message;
}

}  // namespace organ_collision
