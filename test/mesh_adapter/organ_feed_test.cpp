#include "mesh_adapter/organ_feed.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "refusal.hpp"
#include "test/grid_surface.hpp"

namespace organ_collision {
namespace {

constexpr std::uint32_t kLastTopology = 4294967294;  // The second mesh's wraps to 0.

/// Keeps what the feed sent in the last call: `mesh_` or `vertices_`. The other one is null.
class OrganFeedTest : public testing::Test {
 protected:
  void send(const GridSurface& grid, const std::string& frame = "liver") {
    ReceivedSurface surface{frame, stamp_ += ros::Duration(0.01), grid.vertices, grid.triangles()};
    send(surface);
  }
  void send(ReceivedSurface& surface) {
    mesh_.reset();
    vertices_.reset();
    feed_.send(surface);
    ASSERT_NE(mesh_ == nullptr, vertices_ == nullptr);
  }
  void send_vertices(const std::vector<float>& vertices, const std::string& frame = "liver") {
    mesh_.reset();
    vertices_.reset();
    feed_.send_vertices(frame, stamp_ += ros::Duration(0.01), vertices);
    ASSERT_TRUE(vertices_);
  }

  template <typename Message>
  void expect(const boost::shared_ptr<Message>& message, std::uint32_t revision,
              const std::vector<float>& vertices) {
    ASSERT_TRUE(message);
    EXPECT_EQ(message->organ, "organ");
    EXPECT_EQ(message->header.frame_id, "liver");
    EXPECT_EQ(message->header.stamp, stamp_);
    EXPECT_EQ(message->topology, kLastTopology + revision);
    EXPECT_EQ(message->vertices, vertices);
  }
  void expect_mesh(const OrganMeshPtr& message, std::uint32_t revision, const GridSurface& grid) {
    expect(message, revision, grid.vertices);
    EXPECT_EQ(message->triangles, grid.triangles());
  }

  const GridSurface grid_ = grid_surface(3), moved_ = grid_surface(3, 0.4);
  const GridSurface other_ = shuffled(grid_, 5);
  ros::Time stamp_{100.0};
  OrganMeshPtr mesh_;
  OrganVerticesPtr vertices_;
  OrganFeed feed_{"organ",
                  kLastTopology,
                  {[this](const OrganMeshPtr& message) { mesh_ = message; },
                   [this](const OrganVerticesPtr& message) { vertices_ = message; }}};
};

TEST_F(OrganFeedTest, NewTrianglesAreAMeshWithTheNextTopology) {
  send(grid_);
  expect_mesh(mesh_, 1, grid_);
  send(other_);
  expect_mesh(mesh_, 2, other_);
  send(grid_);
  expect_mesh(mesh_, 3, grid_);
}

TEST_F(OrganFeedTest, TheSameTrianglesAreVertices) {
  send(grid_);
  send(moved_);
  expect(vertices_, 1, moved_.vertices);
  expect_mesh(feed_.mesh(), 1, moved_);
}

TEST_F(OrganFeedTest, MoreVerticesAreANewMeshEvenIfNoTriangleHasThem) {
  send(grid_);
  GridSurface larger = grid_;
  larger.vertices.insert(larger.vertices.end(), {0.1f, 0.2f, 0.3f});
  send(larger);
  expect_mesh(mesh_, 2, larger);
}

TEST_F(OrganFeedTest, AnotherFrameIsAMeshOfTheSameTopology) {
  send(grid_, "table");
  send(moved_);
  expect_mesh(mesh_, 1, moved_);
  send(grid_);
  expect(vertices_, 1, grid_.vertices);
}

TEST_F(OrganFeedTest, AnEmptySurfaceRemovesTheOrgan) {
  send(grid_);
  ReceivedSurface none{"", ros::Time(7), {}, {}};
  send(none);
  EXPECT_TRUE(mesh_->vertices.empty() && mesh_->triangles.empty());
  EXPECT_EQ(mesh_->organ, "organ");
  EXPECT_EQ(feed_.mesh(), nullptr);
  expect_words(refusal([&] { send_vertices(grid_.vertices); }), {"no mesh: ", "16 vertices"});
  send(grid_);
  expect_mesh(mesh_, 2, grid_);
}

TEST_F(OrganFeedTest, VerticesNeedAMeshOfAsMany) {
  expect_words(refusal([&] { send_vertices(grid_.vertices); }),
               {"no mesh: ", "16 vertices", "'organ'"});
  send(grid_);
  for (const std::size_t count : {0, 15, 17}) {
    expect_words(refusal([&] { send_vertices(std::vector<float>(3 * count)); }),
                 {"wrong number of vertices: ", std::to_string(count) + " vertices", "has, 16"});
  }
  send_vertices(moved_.vertices);
  expect(vertices_, 1, moved_.vertices);
  expect_mesh(feed_.mesh(), 1, moved_);
}

TEST_F(OrganFeedTest, WhatTheCollisionNodeRefusesIsSentButNotRemembered) {
  send(grid_);
  const ros::Time good = stamp_;
  std::vector<float> vertices = moved_.vertices;
  vertices[10] = std::nanf("");
  send_vertices(vertices);  // It is sent all the same.
  EXPECT_EQ(feed_.mesh()->vertices, grid_.vertices);
  send_vertices(moved_.vertices, "table");
  EXPECT_EQ(vertices_->header.frame_id, "table");
  EXPECT_EQ(feed_.mesh()->vertices, grid_.vertices);
  EXPECT_EQ(feed_.mesh()->header.stamp, good);

  GridSurface broken = other_;
  broken.faces[4][1] = 16;
  send(broken);
  expect(mesh_, 2, broken.vertices);
  EXPECT_EQ(feed_.mesh()->triangles, grid_.triangles());
  send(moved_);
  expect(vertices_, 1, moved_.vertices);
}

TEST_F(OrganFeedTest, AMeshThatFollowsARefusedOneIsSentAsAMesh) {
  GridSurface broken = grid_;
  broken.vertices[0] = std::nanf("");
  send(broken);
  EXPECT_EQ(feed_.mesh(), nullptr);
  send(grid_);
  expect_mesh(mesh_, 2, grid_);
}

TEST_F(OrganFeedTest, VerticesAreNotCopied) {
  send(grid_);
  ReceivedSurface surface{"liver", ros::Time(7), moved_.vertices, moved_.triangles()};
  const float* address = surface.vertices.data();
  send(surface);
  EXPECT_EQ(vertices_->vertices.data(), address);
}

}  // namespace
}  // namespace organ_collision
