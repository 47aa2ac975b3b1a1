#include "robot_reply.hpp"

#include <organ_collision/RobotRecord.h>

#include <cstdint>
#include <utility>

#include "ros/messages/checked_messages.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

struct Malformed : std::runtime_error {
  Malformed() : std::runtime_error("malformed reply") {}
};

static_assert(RobotShape::SPHERE == static_cast<int>(ShapeKind::kSphere) &&
              RobotShape::CYLINDER == static_cast<int>(ShapeKind::kCylinder) &&
              RobotShape::BOX == static_cast<int>(ShapeKind::kBox) &&
              RobotShape::MESH == static_cast<int>(ShapeKind::kMesh));

void write(const ShapeDescription& shape, RobotShape& message) {
  message.kind = static_cast<std::uint8_t>(shape.kind);
  Eigen::Map<Vector3d>(&message.pose[0]) = shape.pose.position;
  Eigen::Map<Eigen::Vector4d>(&message.pose[3]) = shape.pose.orientation.coeffs();
  Eigen::Map<Vector3d>(&message.size[0]) = shape.size;
  message.file = shape.mesh.file;
  message.vertices.reserve(3 * shape.mesh.vertices.size());
  for (const Vector3d& vertex : shape.mesh.vertices) {
    message.vertices.insert(message.vertices.end(), vertex.data(), vertex.data() + 3);
  }
  message.triangles.reserve(3 * shape.mesh.triangles.size());
  for (const FaceIndices& corners : shape.mesh.triangles) {
    message.triangles.insert(message.triangles.end(), corners.begin(), corners.end());
  }
}

ShapeDescription shape_of(const RobotShape& message) {
  const std::vector<double>& vertices = message.vertices;
  const std::vector<std::uint32_t>& triangles = message.triangles;
  if (message.kind > RobotShape::MESH) throw Malformed();
  if (vertices.size() % 3 != 0 || triangles.size() % 3 != 0) throw Malformed();
  ShapeDescription shape{static_cast<ShapeKind>(message.kind),
                         {Vector3d(&message.pose[0]), Eigen::Quaterniond(&message.pose[3])},
                         Vector3d(&message.size[0]),
                         {message.file, {}, {}}};
  shape.mesh.vertices.reserve(vertices.size() / 3);
  for (std::size_t i = 0; i < vertices.size(); i += 3) {
    shape.mesh.vertices.emplace_back(&vertices[i]);
  }
  shape.mesh.triangles.reserve(triangles.size() / 3);
  for (std::size_t i = 0; i < triangles.size(); i += 3) {
    shape.mesh.triangles.push_back({triangles[i], triangles[i + 1], triangles[i + 2]});
  }
  return shape;
}

std::vector<LinkDescription> links_of(const RobotRecord& record) {
  std::vector<LinkDescription> links;
  for (const RobotLink& message : record.links) {
    LinkDescription& link = links.emplace_back();
    link.joint = message.joint;
    for (const RobotShape& shape : message.shapes) link.shapes.push_back(shape_of(shape));
  }
  return links;
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
  if (record.kind == RobotRecord::REFUSAL) {
    reply.refusal = record.text;
  } else {
    reply.links = links_of(record);
  }
}

}  // namespace

std::string reading_record(const std::string& what) {
  return text_record(RobotRecord::READING, what);
}

std::string refusal_record(const std::string& why) {
  return text_record(RobotRecord::REFUSAL, why);
}

std::string links_record(const std::vector<LinkDescription>& links) {
  RobotRecord record;
  record.kind = RobotRecord::LINKS;
  for (const LinkDescription& link : links) {
    RobotLink& message = record.links.emplace_back();
    message.joint = link.joint;
    for (const ShapeDescription& shape : link.shapes) {
      write(shape, message.shapes.emplace_back());
    }
  }
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
