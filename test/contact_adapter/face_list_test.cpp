#include "contact_adapter/face_list.hpp"

#include <gtest/gtest.h>

using namespace organ_collision;

TEST(FaceList, RisingAndEachOnce) {
  ContactArray contacts;
  for (const std::uint32_t face : {7u, 3u, 4000000000u, 7u, 0u}) {
    contacts.contacts.emplace_back();
    contacts.contacts.back().face = face;
  }
  const std_msgs::UInt32MultiArray faces = face_list(contacts);
  EXPECT_EQ(faces.data, (std::vector<std::uint32_t>{0, 3, 7, 4000000000u}));
  ASSERT_EQ(faces.layout.dim.size(), 1u);
  EXPECT_EQ(faces.layout.dim[0].label, "faces");
  EXPECT_EQ(faces.layout.dim[0].size, 4u);
  EXPECT_EQ(faces.layout.dim[0].stride, 4u);
  EXPECT_EQ(faces.layout.data_offset, 0u);
}

TEST(FaceList, NothingTouched) {
  const std_msgs::UInt32MultiArray faces = face_list(ContactArray());
  EXPECT_TRUE(faces.data.empty());
  ASSERT_EQ(faces.layout.dim.size(), 1u);
  EXPECT_EQ(faces.layout.dim[0].size, 0u);
}
