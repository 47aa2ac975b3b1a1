#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <new>

#include "organ_registry_fixture.hpp"
#include "ros/organs/organ_registry.hpp"

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
