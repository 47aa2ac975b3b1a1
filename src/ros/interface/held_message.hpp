#pragma once

#include <boost/make_shared.hpp>
#include <cstdint>
#include <vector>

#include "checked_stream.hpp"

namespace organ_collision {

/// The message whose bytes something holds, such as topic_tools::ShapeShifter or
/// rosbag::MessageInstance. It is read with CheckedStream, which their own instantiate() does not
/// use. The types must agree. Throws ros::serialization::StreamOverrunException.
template <typename Message, typename Holder>
boost::shared_ptr<Message> held_message(const Holder& holder) {
  std::vector<std::uint8_t> bytes(holder.size() + 1);  // One more, because Stream needs an address.
  ros::serialization::OStream copy(bytes.data(), holder.size());
  holder.write(copy);
  auto message = boost::make_shared<Message>();
  CheckedStream(bytes.data(), holder.size()).next(*message);
  return message;
}

}  // namespace organ_collision
