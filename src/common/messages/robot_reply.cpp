#include "robot_reply.hpp"

#include <organ_collision/RobotRecord.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "common/messages/checked_messages.hpp"

namespace organ_collision {
namespace {

bool is_legal(const RobotShape& shape) {
  return shape.kind <= RobotShape::MESH && shape.vertices.size() % 3 == 0 &&
         shape.triangles.size() % 3 == 0;
}

bool is_legal(const RobotRecord& record) {
  return record.kind <= RobotRecord::LINKS &&
         std::all_of(record.links.begin(), record.links.end(), [](const RobotLink& link) {
           return std::all_of(link.shapes.begin(), link.shapes.end(),
                              [](const RobotShape& shape) { return is_legal(shape); });
         });
}

std::string bytes_of(const RobotRecord& record) {
  std::string bytes(ros::serialization::serializationLength(record), '\0');
  ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()),
                                     static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, record);
  return bytes;
}

std::string text_record(std::uint8_t kind, const std::string& text) {
  RobotRecord record;
  record.kind = kind;
  record.text = text;
  return bytes_of(record);
}

}  // namespace

std::string reading_record(const std::string& what) {
  return text_record(RobotRecord::READING, what);
}

std::string refusal_record(const std::string& why) {
  return text_record(RobotRecord::REFUSAL, why);
}

std::string links_record(std::vector<RobotLink> links) {
  RobotRecord record;
  record.kind = RobotRecord::LINKS;
  record.links = std::move(links);
  return bytes_of(record);
}

RobotReply parse_reply(const std::string& bytes) {
  RobotReply reply;
  RobotRecord record;
  CheckedStream stream(reinterpret_cast<const std::uint8_t*>(bytes.data()),
                       static_cast<std::uint32_t>(bytes.size()));
  try {
    for (stream.next(record); record.kind == RobotRecord::READING; stream.next(record)) {
      reply.reading = record.text;
    }
  } catch (const ros::serialization::StreamOverrunException&) {
    return reply;
  }
  if (stream.getLength() != 0 || !is_legal(record)) return reply;
  if (record.kind == RobotRecord::REFUSAL) {
    reply.refusal = std::move(record.text);
  } else {
    reply.links = std::move(record.links);
  }
  return reply;
}

}  // namespace organ_collision
