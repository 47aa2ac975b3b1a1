#include <gtest/gtest.h>

#include <cstdlib>
#include <new>
#include <utility>

#include "grid_surface.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "query/scenes.hpp"

// Counts what C++ code allocates in this program; Mesa is C and allocates by itself.
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

/// An organ that goes through its shapes in a circle, and a tool that goes with it.
class Simulation {
 public:
  Simulation(bool shuffle, bool trocar_moves) : organ_(mesh(shuffle, 0)), before_(organ_) {
    oracle::Random random(9);
    for (std::size_t i = 0; i < kShapes; ++i) {
      const TriangleMesh shape = mesh(shuffle, i);
      shapes_.push_back(std::make_shared<std::vector<float>>(shape.vertices()));
      paths_.push_back(random_path(trocar_moves, random));
    }
  }

  /// A new shape, then both modes, the organ at rest and moving; returns how many contacts there
  /// were.
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
  std::vector<SharedVertices> shapes_;
  std::vector<ToolPath> paths_;
  CollisionRequest request_ = swept(organ_, {}, 0.005);
  CollisionQuery query_;
  CollisionResult result_;
  std::size_t next_ = 0;
};

TEST(Allocation, TheSteadyStateHasNone) {
  for (const bool shuffle : {false, true}) {
    for (const bool trocar_moves : {false, true}) {
      Simulation simulation(shuffle, trocar_moves);
      std::size_t contacts = 0;
      for (std::size_t i = 0; i < 2 * kShapes; ++i) contacts += simulation.step();
      EXPECT_GT(contacts, 1000U);
      const std::size_t before = allocations;
      for (std::size_t i = 0; i < 2 * kShapes; ++i) simulation.step();
      EXPECT_GT(before, 0U);
      EXPECT_EQ(allocations - before, 0U) << (shuffle ? "shuffled" : "in order");
    }
  }
}

}  // namespace
}  // namespace organ_collision
