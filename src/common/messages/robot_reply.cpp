#include "robot_reply.hpp"

#include <organ_collision/RobotRecord.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace organ_collision {
namespace {

namespace ser = ros::serialization;

using Size = std::uint32_t;

bool is_legal(const RobotShape& shape) {
  return shape.kind <= RobotShape::MESH && shape.vertices.size() % 3 == 0 &&
         shape.triangles.size() % 3 == 0;
}

bool is_legal(const RobotLink& link) {
  return std::all_of(link.shapes.begin(), link.shapes.end(),
                     [](const RobotShape& shape) { return is_legal(shape); });
}

}  // namespace

std::string reply_of(const std::vector<RobotLink>& links) {
  RobotRecord record;
  record.links = links;
  const ros::SerializedMessage message = ser::serializeMessage(record);
  return {message.buf.get(), message.buf.get() + message.num_bytes};
}

std::optional<std::vector<RobotLink>> parse_reply(const std::string& bytes) {
  Size size = 0;
  if (bytes.size() < sizeof size) return std::nullopt;
  std::memcpy(&size, bytes.data(), sizeof size);
  // roscpp makes room for lists before it looks whether their bytes are there.
  if (size != bytes.size() - sizeof size) return std::nullopt;
  std::string content = bytes.substr(sizeof size);
  ser::IStream stream(reinterpret_cast<std::uint8_t*>(content.data()), size);
  RobotRecord record;
  try {
    ser::deserialize(stream, record);
  } catch (const ser::StreamOverrunException&) {
    return std::nullopt;
  }
  const bool is_whole =
      stream.getLength() == 0 && std::all_of(record.links.begin(), record.links.end(),
                                             [](const RobotLink& link) { return is_legal(link); });
  if (!is_whole) return std::nullopt;
  return std::move(record.links);
}

}  // namespace organ_collision
