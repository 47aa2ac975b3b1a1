#include "ros/organs/organ_registry.hpp"

#include <gtest/gtest.h>

#include "organ_registry_fixture.hpp"

using namespace organ_collision;

TEST_F(OrganRegistryTest, AMessageIsTheShapeWithoutACopy) {
  const auto first = boost::make_shared<const OrganMesh>(mesh());
  store_.apply(first, ros::Time(7));
  EXPECT_EQ(&store_.at("liver").latest().mesh->vertices(), &first->vertices);
  const auto second = boost::make_shared<const OrganVertices>(vertices(3));
  store_.apply(second, ros::Time(8));
  EXPECT_EQ(&store_.at("liver").latest().mesh->vertices(), &second->vertices);
  EXPECT_EQ(&store_.at("liver").previous().mesh->vertices(), &first->vertices);
}

TEST_F(OrganRegistryTest, OrgansByName) {
  EXPECT_EQ(apply(mesh("liver"), ros::Time(7)), OrganChange::kShape);
  EXPECT_EQ(apply(mesh("kidney"), ros::Time(7)), OrganChange::kShape);
  EXPECT_EQ(store_.organs().size(), 2u);
  EXPECT_EQ(store_.at("kidney").latest().stamp, ros::Time(5));
  EXPECT_EQ(store_.at("kidney").latest().received, ros::Time(7));
  EXPECT_EQ(status_of("spleen"), ContactArray::UNKNOWN_ORGAN);
}

TEST_F(OrganRegistryTest, VerticesMoveTheOrgan) {
  apply(mesh(), ros::Time(7));
  EXPECT_EQ(apply(vertices(3), ros::Time(8)), OrganChange::kShape);
  EXPECT_EQ(store_.at("liver").latest().mesh->vertex(0).z(), 3.0);
  EXPECT_EQ(store_.at("liver").previous().mesh->vertex(0).z(), 0.0);
}

TEST_F(OrganRegistryTest, MeshWithTheTrianglesItHasCountsAsVertices) {
  apply(mesh(), ros::Time(7));
  const auto* faces = &store_.at("liver").latest().mesh->faces();
  OrganMesh again = mesh();
  again.vertices[2] = 4;
  EXPECT_EQ(apply(again, ros::Time(8)), OrganChange::kShape);
  EXPECT_EQ(&store_.at("liver").latest().mesh->faces(), faces);
  EXPECT_EQ(store_.at("liver").latest().mesh->vertex(0).z(), 4.0);
  EXPECT_TRUE(store_.at("liver").previous().mesh);
}

TEST_F(OrganRegistryTest, NewTopologyHasNoPreviousShape) {
  apply(mesh(), ros::Time(7));
  OrganMesh cut = mesh("liver", 2);
  cut.triangles = {0, 1, 2};
  EXPECT_EQ(apply(cut, ros::Time(8)), OrganChange::kShape);
  EXPECT_EQ(store_.at("liver").latest().mesh->face_count(), 1u);
  EXPECT_FALSE(store_.at("liver").previous().mesh);
}

TEST_F(OrganRegistryTest, OtherFrame) {
  apply(mesh(), ros::Time(7));
  OrganMesh elsewhere = mesh();
  elsewhere.header.frame_id = "/table";
  EXPECT_EQ(apply(elsewhere, ros::Time(8)), OrganChange::kFrame);
  EXPECT_EQ(store_.at("liver").frame(), "table");
  EXPECT_FALSE(store_.at("liver").previous().mesh);
}

TEST_F(OrganRegistryTest, RemovedOrganHasNoMesh) {
  apply(mesh(), ros::Time(7));
  OrganMesh nothing;
  nothing.organ = "liver";
  EXPECT_EQ(apply(nothing, ros::Time(8)), OrganChange::kRemoved);
  EXPECT_EQ(status_of("liver"), ContactArray::NO_MESH);
  expect_refused(vertices(1), ContactArray::NO_MESH, "organ without mesh", {"'liver'"});
  apply(mesh("liver", 1), ros::Time(9));
  EXPECT_EQ(status_of("liver"), ContactArray::OK);
}

TEST_F(OrganRegistryTest, ForgetsPreviousShapes) {
  apply(mesh(), ros::Time(7));
  apply(vertices(3), ros::Time(8));
  store_.forget_previous_shapes();
  EXPECT_FALSE(store_.at("liver").previous().mesh);
  EXPECT_EQ(store_.at("liver").latest().mesh->vertex(0).z(), 3.0);
}
