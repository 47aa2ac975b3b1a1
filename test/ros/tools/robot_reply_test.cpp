#include "ros/tools/robot_reply.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <random>

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

std::vector<LinkDescription> links() {
  const ShapePose pose{{0.1, -0.2, 0.3}, {0.5, -0.5, 0.5, -0.5}};
  return {
      {"wrist",
       {{ShapeKind::kSphere, pose, {0.01, 0.0, 0.0}}, {ShapeKind::kBox, pose, {1.0, 2.0, 3.0}}}},
      {"", {}},
      {"jaw_joint",
       {{ShapeKind::kCylinder, pose, {0.02, 0.5, 0.0}},
        {ShapeKind::kMesh,
         {},
         {0.0, 0.0, 0.0},
         {"jaw.stl",
          {Vector3d(1, 2, 3), Vector3d(4, 5, 6), Vector3d(-1, 0.1, 1e-300)},
          {{0, 1, 2}, {2, 1, 0}}}}}}};
}

void expect_same(const ShapeDescription& shape, const ShapeDescription& sent) {
  EXPECT_EQ(shape.kind, sent.kind);
  EXPECT_EQ(shape.pose.position, sent.pose.position);
  EXPECT_EQ(shape.pose.orientation.coeffs(), sent.pose.orientation.coeffs());
  EXPECT_EQ(shape.size, sent.size);
  EXPECT_EQ(shape.mesh.file, sent.mesh.file);
  EXPECT_EQ(shape.mesh.vertices, sent.mesh.vertices);
  EXPECT_EQ(shape.mesh.triangles, sent.mesh.triangles);
}

bool is_malformed(const std::string& bytes) {
  const RobotReply reply = parse_reply(bytes);
  return !reply.refusal && !reply.links;
}

}  // namespace

TEST(RobotReply, LinksComeAsTheyWereSent) {
  const RobotReply reply =
      parse_reply(reading_record("link 'jaw'") + reading_record("") + links_record(links()));
  EXPECT_EQ(reply.reading, "");
  EXPECT_FALSE(reply.refusal);
  ASSERT_TRUE(reply.links);
  ASSERT_EQ(reply.links->size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const LinkDescription &link = reply.links->at(i), sent = links()[i];
    EXPECT_EQ(link.joint, sent.joint);
    ASSERT_EQ(link.shapes.size(), sent.shapes.size());
    for (std::size_t k = 0; k < sent.shapes.size(); ++k) {
      expect_same(link.shapes[k], sent.shapes[k]);
    }
  }
}

TEST(RobotReply, RefusalsComeAsTheyWereSent) {
  const RobotReply reply = parse_reply(refusal_record("link 'jaw' is unknown"));
  EXPECT_EQ(reply.refusal, "link 'jaw' is unknown");
  EXPECT_FALSE(reply.links);
}

TEST(RobotReply, WhatWasReadLastIsKnownWithoutTheRest) {
  const RobotReply reply = parse_reply(reading_record("link 'a'") + reading_record("link 'b'"));
  EXPECT_EQ(reply.reading, "link 'b'");
  EXPECT_TRUE(is_malformed(reading_record("link 'a'")));
}

TEST(RobotReply, NothingButAWholeReplyIsTaken) {
  for (const std::string& bytes :
       {reading_record("link 'jaw'") + links_record(links()), refusal_record("no such file")}) {
    EXPECT_FALSE(is_malformed(bytes));
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      EXPECT_TRUE(is_malformed(bytes.substr(0, size))) << size;
    }
    EXPECT_TRUE(is_malformed(bytes + '\0'));
    EXPECT_TRUE(is_malformed(bytes + bytes));
  }
}

// Whatever value a count, a kind or a number gets, the parser allocates no more than the reply
// could hold.
TEST(RobotReply, AnyBytesDoNoHarm) {
  const std::string whole = links_record(links());
  for (std::size_t at = 0; at + 4 <= whole.size(); ++at) {
    for (const std::uint32_t word : {~std::uint32_t{0}, std::uint32_t{1} << 30, std::uint32_t{4}}) {
      std::string bytes = whole;
      std::memcpy(&bytes[at], &word, sizeof(word));
      EXPECT_NO_THROW(parse_reply(bytes)) << at << ": " << word;
    }
  }
  std::mt19937 random(7);
  for (int i = 0; i < 20000; ++i) {
    std::string bytes = whole;
    for (int changes = 0; changes < 3; ++changes) {
      bytes[random() % bytes.size()] = static_cast<char>(random());
    }
    EXPECT_NO_THROW(parse_reply(bytes)) << i;
  }
}
