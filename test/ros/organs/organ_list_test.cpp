#include "ros/organs/organ_list.hpp"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>

#include "test/ros/organs/solids.hpp"

using namespace organ_collision;

namespace {

OrganMeshConstPtr message(const std::string& organ, const std::vector<std::uint32_t>& triangles,
                          double stamp) {
  const auto mesh = boost::make_shared<OrganMesh>();
  mesh->header.frame_id = "/" + organ + "_frame";
  mesh->header.stamp = ros::Time(stamp);
  mesh->organ = organ;
  mesh->topology = 7;
  mesh->vertices = corners();
  mesh->triangles = triangles;
  return mesh;
}

}  // namespace

TEST(OrganList, EverythingAboutEachOrgan) {
  OrganRegistry organs{MeshLimits{}};
  EXPECT_TRUE(list_organs(organs).empty());
  organs.apply(message("spleen", {0, 1, 2}, 3.0), ros::Time(9));
  organs.apply(message("kidney", kInward, 4.0), ros::Time(9));
  const std::vector<ListedOrgan> list = list_organs(organs);
  ASSERT_EQ(list.size(), 2u);

  const OrganInfo kidney = completed(list[0]);
  EXPECT_EQ(kidney.name, "kidney");
  EXPECT_EQ(kidney.frame, "kidney_frame");
  EXPECT_EQ(kidney.topology, 7u);
  EXPECT_EQ(kidney.faces, 4u);
  EXPECT_EQ(kidney.vertices, 4u);
  EXPECT_TRUE(kidney.closed);
  EXPECT_NEAR(kidney.volume, -1e-5, 1e-11);
  EXPECT_FLOAT_EQ(static_cast<float>(kidney.low.x), 0.1F);
  EXPECT_FLOAT_EQ(static_cast<float>(kidney.low.z), 0.3F);
  EXPECT_FLOAT_EQ(static_cast<float>(kidney.high.y), 0.24F);
  EXPECT_EQ(kidney.stamp, ros::Time(4.0));

  const OrganInfo spleen = completed(list[1]);
  EXPECT_EQ(spleen.name, "spleen");
  EXPECT_FALSE(spleen.closed);
  EXPECT_EQ(spleen.volume, 0.0);
}

TEST(OrganList, VolumeAndBoxAreOfTheLatestShape) {
  OrganRegistry organs{MeshLimits{}};
  organs.apply(message("kidney", kOutward, 4.0), ros::Time(9));
  const auto larger = boost::make_shared<OrganMesh>(*message("kidney", kOutward, 5.0));
  for (float& coordinate : larger->vertices) coordinate *= 2.0F;
  organs.apply(OrganMeshConstPtr(larger), ros::Time(9));
  const OrganInfo kidney = completed(list_organs(organs).front());
  EXPECT_NEAR(kidney.volume, 8e-5, 1e-10);
  EXPECT_FLOAT_EQ(static_cast<float>(kidney.high.x), 0.26F);
  EXPECT_EQ(kidney.stamp, ros::Time(5.0));
}
