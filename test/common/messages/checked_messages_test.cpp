#include "common/messages/checked_messages.hpp"

#include <gtest/gtest.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/QueryCollisionBatch.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <cstring>

namespace organ_collision {
namespace {

using ros::serialization::StreamOverrunException;

template <typename Message>
std::vector<std::uint8_t> bytes_of(const Message& message) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

template <typename Message>
Message read(std::vector<std::uint8_t> bytes) {
  Message message;
  CheckedStream(bytes.data(), static_cast<std::uint32_t>(bytes.size())).next(message);
  return message;
}

/// Replaces the last four bytes: in the messages below, the length of their last list.
std::vector<std::uint8_t> with_last_count(std::vector<std::uint8_t> bytes, std::uint32_t count) {
  std::memcpy(bytes.data() + bytes.size() - sizeof count, &count, sizeof count);
  return bytes;
}

OrganMesh mesh() {
  OrganMesh message;
  message.header.frame_id = "liver_frame";
  message.organ = "liver";
  message.vertices = {1.0f, 2.0f, 3.0f};
  message.triangles = {0, 0, 0};
  return message;
}

TEST(CheckedStreamTest, ReadsWhatRoscppWrites) {
  EXPECT_EQ(bytes_of(read<OrganMesh>(bytes_of(mesh()))), bytes_of(mesh()));
  tf2_msgs::TFMessage transforms;
  transforms.transforms.resize(3);
  transforms.transforms[1].child_frame_id = "tip";
  EXPECT_EQ(read<tf2_msgs::TFMessage>(bytes_of(transforms)).transforms[1].child_frame_id, "tip");
  QueryCollisionBatchRequest request;
  request.link_motions.resize(2);
  request.link_motions[1].links.resize(4);
  EXPECT_EQ(read<QueryCollisionBatchRequest>(bytes_of(request)).link_motions[1].links.size(), 4U);
}

TEST(CheckedStreamTest, RefusesEveryMessageThatIsCutOff) {
  const std::vector<std::uint8_t> whole = bytes_of(mesh());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::vector<std::uint8_t> cut(whole.begin(),
                                        whole.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_THROW(read<OrganMesh>(cut), StreamOverrunException) << size;
  }
}

/// The last two of these counts would overflow a size in bytes of 32 bits, and roscpp would accept
/// them.
TEST(CheckedStreamTest, RefusesAListThatClaimsMoreThanFollows) {
  const auto empty = bytes_of(tf2_msgs::TFMessage());
  for (const std::uint32_t count : {1U, 1U << 26U, 0xffffffffU, 1U << 30U, (1U << 30U) + 1U}) {
    EXPECT_THROW(read<tf2_msgs::TFMessage>(with_last_count(empty, count)), StreamOverrunException);
    OrganMesh message = mesh();
    message.triangles.clear();
    auto bytes = bytes_of(message);
    const std::size_t at = bytes.size() - 4 - sizeof(std::uint32_t) * 4;  // of `vertices`
    std::memcpy(bytes.data() + at, &count, sizeof count);
    if (count > 3) {
      EXPECT_THROW(read<OrganMesh>(bytes), StreamOverrunException) << count;
    }
  }
}

/// Holds bytes as ShapeShifter and rosbag::MessageInstance do.
struct Holder {
  std::uint32_t size() const { return static_cast<std::uint32_t>(bytes.size()); }
  void write(ros::serialization::OStream& stream) const {
    std::copy(bytes.begin(), bytes.end(), stream.advance(size()));
  }
  std::vector<std::uint8_t> bytes;
};

TEST(HeldMessageTest, IsReadAsItWasWrittenOrRefused) {
  EXPECT_EQ(*held_message<OrganMesh>(Holder{bytes_of(mesh())}), mesh());
  for (const std::size_t size : {0U, 7U, 30U}) {
    EXPECT_THROW(held_message<OrganMesh>(Holder{std::vector<std::uint8_t>(size)}),
                 StreamOverrunException);
  }
}

}  // namespace
}  // namespace organ_collision
