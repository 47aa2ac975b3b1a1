#include "ros/tools/robot_reply.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <random>

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

ShapePose pose() { return {{0.1, -0.2, 0.3}, {0.5, -0.5, 0.5, -0.5}}; }

std::vector<LinkDescription> links() {
  return {{"wrist", {SphereDescription{pose(), 0.01}, BoxDescription{pose(), {1.0, 2.0, 3.0}}}},
          {"", {}},
          {"jaw_joint",
           {CylinderDescription{pose(), 0.02, 0.5},
            MeshDescription{"jaw.stl",
                            {Vector3d(1, 2, 3), Vector3d(4, 5, 6), Vector3d(-1, 0.1, 1e-300)},
                            {{0, 1, 2}, {2, 1, 0}}}}}};
}

void expect_pose(const ShapePose& other) {
  EXPECT_EQ(other.position, pose().position);
  EXPECT_EQ(other.orientation.coeffs(), pose().orientation.coeffs());
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
  const LinkDescription& first = reply.links->at(0);
  EXPECT_EQ(first.joint, "wrist");
  ASSERT_EQ(first.shapes.size(), 2u);
  expect_pose(std::get<SphereDescription>(first.shapes[0]).pose);
  EXPECT_EQ(std::get<SphereDescription>(first.shapes[0]).radius, 0.01);
  expect_pose(std::get<BoxDescription>(first.shapes[1]).pose);
  EXPECT_EQ(std::get<BoxDescription>(first.shapes[1]).size, Vector3d(1, 2, 3));
  EXPECT_EQ(reply.links->at(1).joint, "");
  EXPECT_TRUE(reply.links->at(1).shapes.empty());
  const LinkDescription& last = reply.links->at(2);
  EXPECT_EQ(last.joint, "jaw_joint");
  ASSERT_EQ(last.shapes.size(), 2u);
  expect_pose(std::get<CylinderDescription>(last.shapes[0]).pose);
  EXPECT_EQ(std::get<CylinderDescription>(last.shapes[0]).radius, 0.02);
  EXPECT_EQ(std::get<CylinderDescription>(last.shapes[0]).length, 0.5);
  const auto sent = std::get<MeshDescription>(links()[2].shapes[1]);
  const auto& mesh = std::get<MeshDescription>(last.shapes[1]);
  EXPECT_EQ(mesh.file, sent.file);
  EXPECT_EQ(mesh.vertices, sent.vertices);
  EXPECT_EQ(mesh.triangles, sent.triangles);
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

// Each word of eight bytes is a count, a kind or a number. Whatever value it gets, the parser
// allocates no more than the reply could hold.
TEST(RobotReply, AnyBytesDoNoHarm) {
  const std::string whole = links_record(links());
  for (std::size_t at = 0; at + 8 <= whole.size(); ++at) {
    for (const std::uint64_t word : {~std::uint64_t{0}, std::uint64_t{1} << 61, std::uint64_t{4}}) {
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
