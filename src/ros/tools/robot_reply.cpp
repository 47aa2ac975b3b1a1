#include "robot_reply.hpp"

#include <organ_collision/RobotRecord.h>

#include <cstdint>
#include <utility>

#include "ros/messages/checked_messages.hpp"

namespace organ_collision {
namespace {

struct Malformed : std::runtime_error {
  Malformed() : std::runtime_error("malformed reply") {}
};

void check(const RobotShape& shape) {
  if (shape.kind > RobotShape::MESH) throw Malformed();
  if (shape.vertices.size() % 3 != 0 || shape.triangles.size() % 3 != 0) throw Malformed();
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

/// Throws a std::runtime_error; what was read before that stays in `reply`.
void read(CheckedStream stream, RobotReply& reply) {
  RobotRecord record;
  for (stream.next(record); record.kind == RobotRecord::READING; stream.next(record)) {
    reply.reading = record.text;
  }
  if (stream.getLength() != 0 || record.kind > RobotRecord::LINKS) throw Malformed();
  for (const RobotLink& link : record.links) {
    for (const RobotShape& shape : link.shapes) check(shape);
  }
  if (record.kind == RobotRecord::REFUSAL) {
    reply.refusal = std::move(record.text);
  } else {
    reply.links = std::move(record.links);
  }
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
  try {
    read({reinterpret_cast<const std::uint8_t*>(bytes.data()),
          static_cast<std::uint32_t>(bytes.size())},
         reply);
  } catch (const std::runtime_error&) {
    // The reply has neither links nor a refusal.
  }
  return reply;
}

}  // namespace organ_collision
