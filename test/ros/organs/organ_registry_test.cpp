#include "ros/organs/organ_registry.hpp"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <cmath>
#include <limits>
#include <new>

#include "organ_fixture.hpp"

using namespace organ_collision;

namespace {

/// A header such as roscpp makes for each connection.
ros::M_stringPtr header() {
  return ros::M_stringPtr(new ros::M_string{{"callerid", "/simulator"}});
}

}  // namespace

TEST(ConnectionSet, KnowsConnectionsAndNotWhatTheirHeadersSay) {
  const ros::M_stringPtr first = header(), second = header();
  ConnectionSet known;
  EXPECT_FALSE(known.contains(first));
  known.add(first);
  known.add(first);
  EXPECT_TRUE(known.contains(first));
  EXPECT_FALSE(known.contains(second));
  known.add(second);
  EXPECT_TRUE(known.contains(first));
  EXPECT_TRUE(known.contains(second));
}

TEST(ConnectionSet, AMessageWithoutConnectionIsOfOneThatIsKnownOnceAdded) {
  ConnectionSet known;
  EXPECT_FALSE(known.contains({}));
  known.add({});
  EXPECT_TRUE(known.contains({}));
  EXPECT_FALSE(known.contains(header()));
}

TEST(ConnectionSet, ANewConnectionIsNotTakenForAClosedOneAtItsAddress) {
  ConnectionSet known;
  int at_the_same_address = 0;
  for (int i = 0; i < 100; ++i) {
    ros::M_stringPtr closed = header();
    const ros::M_string* address = closed.get();
    known.add(closed);
    closed.reset();
    const ros::M_stringPtr opened = header();
    at_the_same_address += opened.get() == address ? 1 : 0;
    EXPECT_FALSE(known.contains(opened));
  }
  EXPECT_GT(at_the_same_address, 0) << "this run of the test has shown nothing";
}

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

using namespace organ_collision;

TEST_F(OrganRegistryTest, OrganWhoseMeshesWereAllRefusedHasNoMesh) {
  OrganMesh bad = mesh();
  bad.triangles[2] = 4;
  expect_refused(bad, ContactArray::INVALID_REQUEST, "index out of range", {"'liver'", "4"});
  EXPECT_EQ(status_of("liver"), ContactArray::NO_MESH);
  bad.header.frame_id = "";
  bad.organ = "spleen";
  expect_refused(bad, ContactArray::INVALID_REQUEST, "empty frame");
  EXPECT_EQ(status_of("spleen"), ContactArray::NO_MESH);
}

TEST_F(OrganRegistryTest, IllegalNamesAreRefusedAndNotKept) {
  const std::uint8_t invalid = ContactArray::INVALID_REQUEST;
  for (const std::string& name : {std::string(10'000'000, 'x'), std::string("li\nver")}) {
    OrganMesh bad = mesh(name);
    expect_refused(bad, invalid, "illegal name", {"organ"});
    bad.vertices.clear();
    bad.triangles.clear();
    expect_refused(bad, invalid, "illegal name", {"organ"});
    EXPECT_EQ(status_of(name), ContactArray::UNKNOWN_ORGAN);
    OrganVertices bad_vertices = vertices(1);
    bad_vertices.organ = name;
    expect_refused(bad_vertices, invalid, "illegal name", {"organ"});
    bad = mesh();
    bad.header.frame_id = name;
    expect_refused(bad, invalid, "illegal name", {"header.frame_id"});
  }
  apply(mesh(), ros::Time(7));
  OrganVertices elsewhere = vertices(1);
  elsewhere.header.frame_id = std::string(10'000'000, 'x');
  expect_refused(elsewhere, invalid, "illegal name", {"header.frame_id"});
}

TEST_F(OrganRegistryTest, BadMeshesLeaveTheGoodOne) {
  apply(mesh(), ros::Time(7));
  for (const std::uint32_t topology : {1, 2}) {
    const std::uint8_t invalid = ContactArray::INVALID_REQUEST;
    OrganMesh bad = mesh("liver", topology);
    bad.vertices[5] = std::numeric_limits<float>::infinity();
    expect_refused(bad, invalid, "not finite", {"'liver'"});
    bad = mesh("liver", topology);
    bad.vertices.pop_back();
    expect_refused(bad, invalid, "wrong size", {"11"});
    bad = mesh("liver", topology);
    bad.header.frame_id = "/";
    expect_refused(bad, invalid, "empty frame");
    bad = mesh("", topology);
    expect_refused(bad, invalid, "empty name");
  }
  OrganMesh bad = mesh("liver", 2);
  bad.triangles.pop_back();
  expect_refused(bad, ContactArray::INVALID_REQUEST, "wrong size", {"5"});
  bad = mesh("liver", 2);
  bad.triangles.clear();
  expect_refused(bad, ContactArray::INVALID_REQUEST, "no triangles");
  bad = mesh("liver", 2);
  bad.triangles.insert(bad.triangles.end(), {0, 1, 3});
  expect_refused(bad, ContactArray::INVALID_REQUEST, "too many faces", {"3", "2"});
  bad = mesh("liver", 1);
  bad.triangles = {0, 1, 2, 1, 2, 3};
  expect_refused(bad, ContactArray::INVALID_REQUEST, "same topology, other triangles",
                 {"'liver'", "1"});
}

TEST_F(OrganRegistryTest, MeshesThatCannotBeMadeLeaveTheGoodOne) {
  const auto apply_without_memory = [&](const std::string& organ) {
    const auto message = boost::make_shared<const OrganMesh>(mesh(organ, 2));
    try {
      store_.apply(message, {}, ros::Time(8), []() -> TriangleMesh { throw std::bad_alloc(); });
      ADD_FAILURE() << "accepted";
    } catch (const Rejection& rejection) {
      EXPECT_EQ(rejection.status(), ContactArray::INVALID_REQUEST);
      EXPECT_EQ(rejection.reason(), "not made");
      EXPECT_NE(std::string(rejection.what()).find("'" + organ + "'"), std::string::npos);
      EXPECT_NE(std::string(rejection.what()).find("bad_alloc"), std::string::npos);
    }
  };
  apply(mesh(), ros::Time(7));
  apply_without_memory("liver");
  EXPECT_EQ(store_.at("liver").latest().mesh->topology(), 1u);
  EXPECT_EQ(store_.at("liver").latest().received, ros::Time(7));
  apply_without_memory("spleen");
  EXPECT_EQ(status_of("spleen"), ContactArray::NO_MESH);
}

TEST_F(OrganRegistryTest, BadVerticesLeaveTheGoodOnes) {
  expect_refused(vertices(1), ContactArray::UNKNOWN_ORGAN, "unknown organ", {"'liver'"});
  apply(mesh(), ros::Time(7));
  const std::uint8_t invalid = ContactArray::INVALID_REQUEST;
  expect_refused(vertices(1, 2), invalid, "other topology", {"2", "1"});
  OrganVertices bad = vertices(1);
  bad.header.frame_id = "table";
  expect_refused(bad, invalid, "other frame", {"'table'", "'liver_frame'"});
  bad.header.frame_id = "";
  expect_refused(bad, invalid, "empty frame", {"'liver_frame'"});
  bad = vertices(1);
  bad.organ = "";
  expect_refused(bad, invalid, "empty name");
  bad = vertices(1);
  bad.vertices.resize(9);
  expect_refused(bad, invalid, "wrong size", {"9", "12"});
  bad = vertices(std::nanf(""));
  expect_refused(bad, invalid, "not finite");
}

TEST_F(OrganRegistryTest, AnOrganWithoutMeshSaysWhyTheLastOneWasRefused) {
  const auto why = [this](const std::string& organ) -> std::string {
    try {
      store_.at(organ);
    } catch (const Rejection& rejection) {
      return rejection.what();
    }
    return "";
  };
  OrganMesh bad = mesh();
  bad.triangles[2] = 4;
  expect_refused(bad, ContactArray::INVALID_REQUEST, "index out of range");
  EXPECT_NE(why("liver").find("face 0 refers to vertex 4 of 4"), std::string::npos) << why("liver");
  bad = mesh();
  bad.vertices.pop_back();
  expect_refused(bad, ContactArray::INVALID_REQUEST, "wrong size");
  EXPECT_NE(why("liver").find("11 vertex coordinates"), std::string::npos) << why("liver");
  expect_refused(vertices(1), ContactArray::NO_MESH, "organ without mesh",
                 {"11 vertex coordinates"});
  EXPECT_EQ(why("liver").find("face 0"), std::string::npos) << "only the last reason counts";

  apply(mesh(), ros::Time(7));
  EXPECT_EQ(store_.last_refusal("liver"), "");
  expect_refused(bad, ContactArray::INVALID_REQUEST, "wrong size");
  EXPECT_EQ(why("liver"), "") << "the good mesh stays";
  EXPECT_NE(store_.last_refusal("liver"), "");
  OrganMesh removal = mesh();
  removal.vertices.clear();
  removal.triangles.clear();
  apply(removal, ros::Time(8));
  EXPECT_EQ(why("liver"), "organ 'liver' was removed; send a mesh on organ_mesh");
}

TEST_F(OrganRegistryTest, UnknownOrganIsToldWhichAreKnown) {
  apply(mesh("liver"), ros::Time(7));
  apply(mesh("kidney"), ros::Time(7));
  try {
    store_.at("spleen");
    ADD_FAILURE();
  } catch (const Rejection& rejection) {
    EXPECT_STREQ(rejection.what(), "organ 'spleen' is unknown; known are 'kidney', 'liver'");
  }
}

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
