#include <gtest/gtest.h>

#include <cstdlib>
#include <new>
#include <utility>

#include "organ_collision/query/collision_query.hpp"
#include "scenes.hpp"
#include "test/geometry/tool/tool_meshes.hpp"
#include "test/grid_surface.hpp"

// Counts the allocations by C++ code in this program. Mesa is written in C, so its allocations do
// not count.
namespace {
std::size_t allocations = 0;

void* counted(std::size_t size) {
  ++allocations;
  void* const memory = std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*size*/) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t /*size*/) noexcept { std::free(memory); }

namespace organ_collision {
namespace {

constexpr std::size_t kShapes = 8;

/// A link of a box, a cylinder and a ball, and a link of a mesh with 512 faces.
std::vector<Link> some_links() {
  oracle::Random random(10);
  const auto pose = [&] { return oracle::random_pose(0.02, random); };
  return {{"jaw",
           {LinkPart::box(pose(), {0.02, 0.03, 0.05}), LinkPart::cylinder(pose(), 0.01, 0.06),
            LinkPart::sphere(pose().translation(), 0.015)}},
          {"plate", {LinkPart::mesh(wavy_mesh(16, 0.4).surface())}}};
}

/// An organ that repeats a cycle of shapes, and a tool that repeats a cycle of paths. It asks for
/// everything that a query can tell.
class Simulation {
 public:
  Simulation(bool shuffle, bool trocar_moves, std::vector<Link> links)
      : organ_(mesh(shuffle, 0)), before_(organ_), links_(std::move(links)) {
    oracle::Random random(9);
    for (std::size_t i = 0; i < kShapes; ++i) {
      const TriangleMesh shape = mesh(shuffle, i);
      shapes_.push_back(std::make_shared<std::vector<float>>(shape.vertices()));
      paths_.push_back(random_path(trocar_moves, random));
      for (std::size_t link = 0; link < links_.size(); ++link) {
        Eigen::Isometry3d pose = oracle::random_pose(0.02, random);
        for (ToolWaypoint& waypoint : paths_.back()) {
          waypoint.links.push_back(pose);
          pose.linear() *= oracle::random_turn(0.01, random);
          pose.translation() += 1e-3 * random.direction();
        }
      }
    }
    request_.links = &links_;
    request_.margin = 0.004;
    request_.max_near = 20;
    request_.placement = true;
    request_.surface_topology = &topology_;
  }
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Takes the next shape and evaluates both exact modes, with the organ at rest and moving.
  /// Returns the number of contacts.
  std::size_t step() {
    const std::size_t i = next_++ % kShapes;
    std::swap(organ_, before_);
    organ_.move_vertices(shapes_[i]);
    request_.organ = &organ_;
    request_.path.swap(paths_[i]);
    std::size_t contacts = 0;
    for (const QueryMode mode : {QueryMode::kStatic, QueryMode::kSwept}) {
      request_.mode = mode;
      for (const TriangleMesh* before : {static_cast<const TriangleMesh*>(nullptr),
                                         static_cast<const TriangleMesh*>(&before_)}) {
        request_.organ_before = before;
        query_.evaluate(request_, result_);
        contacts += result_.contacts.size();
      }
    }
    request_.path.swap(paths_[i]);
    return contacts;
  }

 private:
  static TriangleMesh mesh(bool shuffle, std::size_t phase) {
    const GridSurface grid = grid_surface(60, 0.3 * static_cast<double>(phase));
    const GridSurface sent = shuffle ? shuffled(grid, 4) : grid;
    return {sent.vertices, sent.triangles()};
  }

  TriangleMesh organ_, before_;
  SurfaceTopology topology_{organ_.faces(), organ_.vertices()};
  std::vector<Link> links_;
  std::vector<SharedVertices> shapes_;
  std::vector<ToolPath> paths_;
  CollisionRequest request_ = swept(organ_, {}, 0.005);
  CollisionQuery query_;
  CollisionResult result_;
  std::size_t next_ = 0;
};

/// Expects that no memory is allocated after all shapes have been used twice.
void expect_none(Simulation& simulation, bool shuffle) {
  std::size_t contacts = 0;
  for (std::size_t i = 0; i < 2 * kShapes; ++i) contacts += simulation.step();
  EXPECT_GT(contacts, 1000U);
  const std::size_t before = allocations;
  for (std::size_t i = 0; i < 2 * kShapes; ++i) simulation.step();
  EXPECT_GT(before, 0U);
  EXPECT_EQ(allocations - before, 0U) << (shuffle ? "shuffled" : "in order");
}

TEST(Allocation, TheSteadyStateHasNone) {
  for (const bool shuffle : {false, true}) {
    for (const bool trocar_moves : {false, true}) {
      Simulation simulation(shuffle, trocar_moves, {});
      expect_none(simulation, shuffle);
    }
  }
}

TEST(Allocation, LinksHaveNoneEither) {
  for (const bool shuffle : {false, true}) {
    Simulation simulation(shuffle, false, some_links());
    expect_none(simulation, shuffle);
  }
}

}  // namespace
}  // namespace organ_collision
