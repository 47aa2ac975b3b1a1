#include "ros/tools/robot_reply.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <random>

using namespace organ_collision;

namespace {

RobotShape shape(std::uint8_t kind, double x, double y, double z) {
  RobotShape shape;
  shape.kind = kind;
  shape.pose = {{0.1, -0.2, 0.3, -0.5, 0.5, -0.5, 0.5}};
  shape.size = {{x, y, z}};
  return shape;
}

std::vector<RobotLink> links() {
  RobotShape mesh = shape(RobotShape::MESH, 0.0, 0.0, 0.0);
  mesh.file = "jaw.stl";
  mesh.vertices = {1, 2, 3, 4, 5, 6, -1, 0.1, 1e-300};
  mesh.triangles = {0, 1, 2, 2, 1, 0};
  std::vector<RobotLink> links(3);
  links[0].joint = "wrist";
  links[0].shapes = {shape(RobotShape::SPHERE, 0.01, 0, 0), shape(RobotShape::BOX, 1, 2, 3)};
  links[2].joint = "jaw_joint";
  links[2].shapes = {shape(RobotShape::CYLINDER, 0.02, 0.5, 0), mesh};
  return links;
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
  EXPECT_EQ(reply.links, links());
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
  std::vector<RobotLink> odd = links();
  odd[2].shapes[1].vertices.pop_back();
  EXPECT_TRUE(is_malformed(links_record(odd)));
  odd[2].shapes[1].kind = RobotShape::MESH + 1;
  EXPECT_TRUE(is_malformed(links_record(odd)));
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
