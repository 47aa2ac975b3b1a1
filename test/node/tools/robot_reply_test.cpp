#include "common/messages/robot_reply.hpp"

#include <gtest/gtest.h>

#include <cstdint>

using namespace organ_collision;

namespace {

RobotShape shape_of(std::uint8_t kind, double x, double y, double z) {
  RobotShape shape;
  shape.kind = kind;
  shape.pose = {{0.1, -0.2, 0.3, -0.5, 0.5, -0.5, 0.5}};
  shape.size = {{x, y, z}};
  return shape;
}

std::vector<RobotLink> two_links() {
  RobotShape mesh = shape_of(RobotShape::MESH, 0.0, 0.0, 0.0);
  mesh.file = "jaw.stl";
  mesh.vertices = {1, 2, 3, 4, 5, 6, -1, 0.1, 1e-300};
  mesh.triangles = {0, 1, 2, 2, 1, 0};
  std::vector<RobotLink> links(3);
  links[0].joint = "wrist";
  links[0].shapes = {shape_of(RobotShape::SPHERE, 0.01, 0, 0), shape_of(RobotShape::BOX, 1, 2, 3)};
  links[2].joint = "jaw_joint";
  links[2].shapes = {shape_of(RobotShape::CYLINDER, 0.02, 0.5, 0), mesh};
  return links;
}

bool is_malformed(const std::string& bytes) {
  const RobotReply reply = parse_reply(bytes);
  return !reply.refusal && !reply.links;
}

}  // namespace

TEST(RobotReply, ComesAsItWasSent) {
  const RobotReply links_after_two = parse_reply(
      reading_record("link 'a'") + reading_record("link 'b'") + links_record(two_links()));
  EXPECT_EQ(links_after_two.reading, "link 'b'");
  EXPECT_FALSE(links_after_two.refusal);
  EXPECT_EQ(links_after_two.links, two_links());
  const RobotReply refusal = parse_reply(refusal_record("link 'jaw' is unknown"));
  EXPECT_EQ(refusal.refusal, "link 'jaw' is unknown");
  EXPECT_FALSE(refusal.links);
  EXPECT_EQ(parse_reply(reading_record("link 'a'")).reading, "link 'a'") << "without the rest";
}

TEST(RobotReply, NothingButAWholeReplyIsTaken) {
  std::vector<RobotLink> odd = two_links();
  odd[2].shapes[1].vertices.pop_back();
  EXPECT_TRUE(is_malformed(links_record(odd)));
  odd[2].shapes[1].kind = RobotShape::MESH + 1;
  EXPECT_TRUE(is_malformed(links_record(odd)));
  for (const std::string& bytes :
       {reading_record("link 'jaw'") + links_record(two_links()), refusal_record("no such file")}) {
    EXPECT_FALSE(is_malformed(bytes));
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      EXPECT_TRUE(is_malformed(bytes.substr(0, size))) << size;
    }
    EXPECT_TRUE(is_malformed(bytes + '\0'));
    EXPECT_TRUE(is_malformed(bytes + bytes));
  }
}
