#include "ros/interface/held_message.hpp"

#include <gtest/gtest.h>
#include <organ_collision/OrganMesh.h>

#include <algorithm>

namespace organ_collision {
namespace {

/// Holds bytes as ShapeShifter and rosbag::MessageInstance do.
struct Holder {
  std::uint32_t size() const { return static_cast<std::uint32_t>(bytes.size()); }
  void write(ros::serialization::OStream& stream) const {
    std::copy(bytes.begin(), bytes.end(), stream.advance(size()));
  }
  std::vector<std::uint8_t> bytes;
};

TEST(HeldMessageTest, IsReadAsItWasWritten) {
  OrganMesh mesh;
  mesh.organ = "liver";
  mesh.vertices = {1.0f, 2.0f, 3.0f};
  Holder holder{std::vector<std::uint8_t>(ros::serialization::serializationLength(mesh))};
  ros::serialization::OStream stream(holder.bytes.data(), holder.size());
  ros::serialization::serialize(stream, mesh);
  EXPECT_EQ(*held_message<OrganMesh>(holder), mesh);
}

TEST(HeldMessageTest, IsRefusedIfItIsCutOff) {
  for (const std::size_t size : {0U, 7U, 30U}) {
    EXPECT_THROW(held_message<OrganMesh>(Holder{std::vector<std::uint8_t>(size)}),
                 ros::serialization::StreamOverrunException);
  }
}

}  // namespace
}  // namespace organ_collision
