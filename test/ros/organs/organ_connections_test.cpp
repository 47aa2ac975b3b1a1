#include <gtest/gtest.h>

#include "organ_registry_fixture.hpp"
#include "ros/organs/organ_registry.hpp"

using namespace organ_collision;

TEST_F(OrganRegistryTest, OtherTrianglesOverANewConnectionAreAnotherOrgan) {
  apply(mesh(), ros::Time(7), first_);
  EXPECT_EQ(apply(vertices(3), ros::Time(8)), OrganChange::kShape);
  OrganMesh other = mesh();
  other.triangles = {0, 1, 3};
  expect_refused(other, ContactArray::INVALID_REQUEST, "same topology, other triangles",
                 {"'liver'", "raise `topology`", "reset"}, first_);
  EXPECT_EQ(apply(other, ros::Time(9), second_), OrganChange::kOrgan);
  EXPECT_EQ(store_.at("liver").latest().mesh->face_count(), 1u);
  EXPECT_FALSE(store_.at("liver").previous().mesh);
  // Messages that still arrive over the old connection do not displace the new organ.
  expect_refused(mesh(), ContactArray::INVALID_REQUEST, "same topology, other triangles", {},
                 first_);
}

TEST_F(OrganRegistryTest, AnotherNumberOfVerticesOverANewConnectionIsAnotherOrgan) {
  apply(mesh(), ros::Time(7), first_);
  OrganMesh more = mesh();
  more.vertices.insert(more.vertices.end(), {5, 5, 5});
  expect_refused(more, ContactArray::INVALID_REQUEST, "wrong size", {}, first_);
  EXPECT_EQ(apply(more, ros::Time(8), second_), OrganChange::kOrgan);
}

TEST_F(OrganRegistryTest, TheSameTrianglesOverANewConnectionCountAsVertices) {
  apply(mesh(), ros::Time(7), first_);
  EXPECT_EQ(apply(mesh(), ros::Time(8), second_), OrganChange::kShape);
  EXPECT_TRUE(store_.at("liver").previous().mesh);
  OrganMesh other = mesh();
  other.triangles = {0, 1, 3};
  expect_refused(other, ContactArray::INVALID_REQUEST, "same topology, other triangles", {},
                 second_);
}

TEST_F(OrganRegistryTest, ARefusedMeshDoesNotMakeItsConnectionKnown) {
  apply(mesh(), ros::Time(7), first_);
  OrganMesh bad = mesh();
  bad.triangles = {0, 1, 4};
  expect_refused(bad, ContactArray::INVALID_REQUEST, "index out of range", {}, second_);
  bad.triangles = {0, 1, 3};
  EXPECT_EQ(apply(bad, ros::Time(8), second_), OrganChange::kOrgan);
}

TEST_F(OrganRegistryTest, ForgottenConnectionsAreNew) {
  apply(mesh(), ros::Time(7), first_);
  store_.forget_connections();
  OrganMesh other = mesh();
  other.triangles = {0, 1, 3};
  EXPECT_EQ(apply(other, ros::Time(8), first_), OrganChange::kOrgan);
  expect_refused(mesh(), ContactArray::INVALID_REQUEST, "same topology, other triangles", {},
                 first_);
}

TEST_F(OrganRegistryTest, WhatIsNewIsSaidBeforehand) {
  EXPECT_TRUE(store_.is_new(mesh(), first_));
  apply(mesh(), ros::Time(7), first_);
  EXPECT_FALSE(store_.is_new(mesh(), first_));
  EXPECT_FALSE(store_.is_new(mesh(), second_));
  EXPECT_TRUE(store_.is_new(mesh("liver", 2), first_));
  OrganMesh other = mesh();
  other.triangles = {0, 1, 3};
  EXPECT_FALSE(store_.is_new(other, first_));
  EXPECT_TRUE(store_.is_new(other, second_));
}
