#include "node/organs/organ_registry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <new>
#include <string>
#include <vector>

#include "test/node/organs/organ_fixture.hpp"

using namespace organ_collision;

TEST_F(OrganRegistryTest, AMessageIsTheShapeWithoutACopy) {
  const auto first = boost::make_shared<const OrganMesh>(mesh());
  store_.apply(first, ros::Time(7));
  EXPECT_EQ(&store_.at("liver").latest().mesh->vertices(), &first->vertices);
  EXPECT_EQ(store_.at("liver").latest().stamp, ros::Time(5));
  EXPECT_EQ(store_.at("liver").latest().received, ros::Time(7));
  const auto second = boost::make_shared<const OrganVertices>(vertices(3));
  EXPECT_EQ(store_.apply(second, ros::Time(8)), OrganChange::kShape);
  EXPECT_EQ(&store_.at("liver").latest().mesh->vertices(), &second->vertices);
  EXPECT_EQ(&store_.at("liver").latest().before->vertices(), &first->vertices);
  const auto* faces = &store_.at("liver").latest().mesh->faces();
  EXPECT_EQ(apply(mesh(), ros::Time(8)), OrganChange::kShape);
  EXPECT_EQ(&store_.at("liver").latest().mesh->faces(), faces) << "they count as vertices";
  EXPECT_TRUE(store_.at("liver").latest().before);
}

TEST_F(OrganRegistryTest, AfterANewTopologyOrFrameThereIsNoPreviousShape) {
  apply(mesh(), ros::Time(7));
  OrganMesh cut = mesh("liver", 2);
  cut.triangles = {0, 1, 2};
  EXPECT_EQ(apply(cut, ros::Time(8)), OrganChange::kShape);
  EXPECT_EQ(store_.at("liver").latest().mesh->face_count(), 1U);
  EXPECT_FALSE(store_.at("liver").latest().before);
  cut.header.frame_id = "/table";
  EXPECT_EQ(apply(cut, ros::Time(9)), OrganChange::kFrame);
  EXPECT_EQ(store_.at("liver").frame(), "table");
  EXPECT_FALSE(store_.at("liver").latest().before);
}

TEST_F(OrganRegistryTest, ForgetsHistory) {
  apply(mesh(), ros::Time(7), first_);
  apply(vertices(3), ros::Time(8));
  store_.begin_histories("reset", ros::Time(8));
  EXPECT_FALSE(store_.at("liver").latest().before);
  EXPECT_EQ(store_.at("liver").latest().mesh->vertex(0).z(), 3.0);
  OrganMesh other = mesh();
  other.triangles = {0, 1, 3};
  EXPECT_EQ(apply(other, ros::Time(8), first_), OrganChange::kOrgan);
  expect_refused(mesh(), ContactArray::INVALID_REQUEST, "same topology, other triangles", {},
                 first_);
}

namespace {

const float kInfinite = std::numeric_limits<float>::infinity();
const std::string kHuge(10'000'000, 'x');

template <typename Message>
struct Refusal {
  std::function<void(Message&)> spoil;
  std::string reason;
  std::vector<std::string> words = {};
  bool is_of_any_topology = true;  ///< else it is refused only where the triangles are new
};

const std::vector<Refusal<OrganMesh>> kBadMeshes = {
    {[](OrganMesh& m) { m.vertices[5] = kInfinite; }, "not finite", {"'liver'"}},
    {[](OrganMesh& m) { m.vertices.pop_back(); }, "wrong size", {"11"}},
    {[](OrganMesh& m) { m.header.frame_id = "/"; }, "empty frame"},
    {[](OrganMesh& m) { m.header.frame_id = ""; }, "empty frame"},
    {[](OrganMesh& m) { m.header.frame_id = kHuge; }, "illegal name", {"header.frame_id"}},
    {[](OrganMesh& m) { m.organ = ""; }, "empty name"},
    {[](OrganMesh& m) { m.organ = kHuge; }, "illegal name", {"organ"}},
    {[](OrganMesh& m) { m.organ = "li\nver"; }, "illegal name", {"organ"}},
    {[](OrganMesh& m) { m.organ = "li\nver", m.vertices.clear(), m.triangles.clear(); },
     "illegal name"},
    {[](OrganMesh& m) { m.triangles[2] = 4; }, "index out of range", {"'liver'", "4"}, false},
    {[](OrganMesh& m) { m.triangles.pop_back(); }, "wrong size", {"5"}, false},
    {[](OrganMesh& m) { m.triangles.clear(); }, "no triangles", {}, false},
    {[](OrganMesh& m) {
       m.triangles.insert(m.triangles.end(), {0, 1, 3});
     },
     "too many faces",
     {"3", "2"},
     false}};

const std::vector<Refusal<OrganVertices>> kBadVertices = {
    {[](OrganVertices& v) { v.topology = 2; }, "other topology", {"2", "1"}},
    {[](OrganVertices& v) { v.header.frame_id = "table"; },
     "other frame",
     {"'table'", "'liver_frame'"}},
    {[](OrganVertices& v) { v.header.frame_id = ""; }, "empty frame", {"'liver_frame'"}},
    {[](OrganVertices& v) { v.header.frame_id = kHuge; }, "illegal name", {"header.frame_id"}},
    {[](OrganVertices& v) { v.organ = ""; }, "empty name"},
    {[](OrganVertices& v) { v.organ = kHuge; }, "illegal name", {"organ"}},
    {[](OrganVertices& v) { v.vertices.resize(9); }, "wrong size", {"9", "12"}},
    {[](OrganVertices& v) { v.vertices[7] = std::nanf(""); }, "not finite"}};

}  // namespace

TEST_F(OrganRegistryTest, BadMessagesLeaveTheGoodOrgan) {
  expect_refused(vertices(1), ContactArray::UNKNOWN_ORGAN, "unknown organ", {"'liver'"});
  apply(mesh("spleen"), ros::Time(7));
  apply(mesh("kidney"), ros::Time(7));
  EXPECT_EQ(why("liver"), "organ 'liver' is unknown; known are 'kidney', 'spleen'");
  for (const bool known : {false, true}) {
    if (known) apply(mesh(), ros::Time(7));
    for (const auto& refusal : kBadMeshes) {
      for (const std::uint32_t topology : {1, 2}) {
        if (known && topology == 1 && !refusal.is_of_any_topology) continue;
        OrganMesh bad = mesh("liver", topology);
        refusal.spoil(bad);
        expect_refused(bad, ContactArray::INVALID_REQUEST, refusal.reason, refusal.words);
      }
    }
    EXPECT_EQ(status_of("liver"), known ? ContactArray::OK : ContactArray::NO_MESH);
    EXPECT_EQ(status_of("li\nver"), ContactArray::UNKNOWN_ORGAN) << "an illegal name is not kept";
  }
  for (const auto& refusal : kBadVertices) {
    OrganVertices bad = vertices(1);
    refusal.spoil(bad);
    expect_refused(bad, ContactArray::INVALID_REQUEST, refusal.reason, refusal.words);
  }
  OrganMesh other = mesh();
  other.triangles = {0, 1, 2, 1, 2, 3};
  expect_refused(other, ContactArray::INVALID_REQUEST, "same topology, other triangles",
                 {"'liver'", "1", "raise `topology`", "reset"});
}

TEST_F(OrganRegistryTest, AnOrganWithoutMeshSaysWhyTheLastOneWasRefused) {
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
  OrganMesh removal;
  removal.organ = "liver";
  apply(removal, ros::Time(8));
  EXPECT_EQ(why("liver"), "organ 'liver' was removed; send a mesh on organ_mesh");
  expect_refused(vertices(1), ContactArray::NO_MESH, "organ without mesh", {"'liver'"});
  apply(mesh("liver", 1), ros::Time(9));
  EXPECT_EQ(status_of("liver"), ContactArray::OK);
}

// An organ's meshes may come over several connections.

// A connection that is closed belongs to a sender that is gone.

/// Each row sends a mesh or vertices, over the connections that its senders have then.
TEST_F(OrganRegistryTest, AShapeOfARestartedSenderBeginsANewHistory) {
  const auto first = OrganChange::kShape, on = OrganChange::kShape, anew = OrganChange::kSender;
  const struct {
    const char* restarts;  ///< the senders of meshes (m) and vertices (v) that restart before it
    char sends;            ///< m: a mesh, v: vertices, c: a mesh with other triangles, as of a cut
    OrganChange change;
  } rows[] = {
      {"", 'm', first},  {"", 'v', on},  // Vertices may come from another node than the mesh.
      {"mv", 'm', anew}, {"", 'v', on},   {"", 'm', on},     {"", 'v', on},
      {"mv", 'v', anew}, {"", 'm', on},   {"", 'v', on},  // Its messages overtake each other.
      {"v", 'm', on},    {"", 'v', anew}, {"", 'v', on},     {"m", 'v', on},
      {"", 'm', anew},   {"", 'v', on},   {"mv", 'c', anew}, {"", 'v', on},
  };
  std::map<char, ros::M_stringPtr> connections{{'m', header()}, {'v', header()}};
  OrganMesh sheet = mesh();
  std::uint64_t history = 0;
  for (const auto& row : rows) {
    SCOPED_TRACE(std::to_string(&row - rows) + ": " + row.restarts + " " + row.sends);
    for (const char* sender = row.restarts; *sender != 0; ++sender) connections[*sender] = header();
    if (row.sends == 'c') sheet.triangles = {0, 1, 3};
    const OrganChange change = row.sends == 'v' ? apply(vertices(3), ros::Time(8), connections['v'])
                                                : apply(sheet, ros::Time(8), connections['m']);
    EXPECT_EQ(change, row.change);
    const History& now = store_.at("liver").history();
    EXPECT_EQ(std::exchange(history, now.number) != now.number, row.change == anew || &row == rows);
    if (row.change == anew) {
      EXPECT_EQ(now.why, "sender restarted");
    }
    const bool has_previous = store_.at("liver").latest().before != nullptr;
    EXPECT_EQ(has_previous, row.change == on && &row != rows) << "the tissue moves";
  }
}

/// roscpp keeps its connection until the master forgets it.
TEST_F(OrganRegistryTest, ASenderThatCrashedIsGoneWhenAnotherOneMovesTheOrgan) {
  const ros::M_stringPtr crashed = header("/left"), next = header("/right"), third = header();
  apply(mesh(), ros::Time(7), crashed);
  apply(vertices(1), ros::Time(8), crashed);
  EXPECT_EQ(apply(vertices(3), ros::Time(8.6), next), OrganChange::kSender);
  EXPECT_EQ(apply(mesh(), ros::Time(8.6), next), OrganChange::kShape);
  EXPECT_EQ(apply(vertices(3), ros::Time(8.7), next), OrganChange::kShape);
  OrganMesh cut = mesh("liver", 2);
  cut.triangles = {0, 1, 2};
  EXPECT_EQ(apply(cut, ros::Time(9.7), third), OrganChange::kShape) << "another node may cut";
}

TEST_F(OrganRegistryTest, TwoOpenSendersAreWarnedOfAndHistoryGoesOn) {
  ros::Time::setNow(ros::Time(5000.0));
  const ros::M_stringPtr left = header("/left"), right = header("/right");
  CapturedLog log;
  apply(mesh(), ros::Time(7), left);
  apply(vertices(1), ros::Time(7), right);
  EXPECT_TRUE(log.take().empty()) << "mesh and vertices may have senders of their own";
  double now = 7.4;  // Later, the other one is known, so that it may be silent for longer.
  for (int i = 0; i < 10; ++i, now += 0.6) {
    EXPECT_EQ(apply(vertices(1), ros::Time(now), i % 2 == 0 ? left : right), OrganChange::kShape);
    EXPECT_TRUE(store_.at("liver").latest().before);
  }
  const std::vector<std::string> lines = log.take();
  ASSERT_EQ(lines.size(), 1U) << "it is said once in 5 s";
  EXPECT_EQ(lines[0].find("WARN organ 'liver' has two senders on organ_vertices, '/right' and "
                          "'/left'"),
            0U)
      << lines[0];
}
