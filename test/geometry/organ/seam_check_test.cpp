#include "geometry/organ/seam_check.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "organ_collision/geometry/tolerances.hpp"
#include "test/closed_surfaces.hpp"

namespace organ_collision {
namespace {

TriangleMesh mesh_of(const GridSurface& surface) { return {surface.vertices, surface.triangles()}; }

/// A vertex that is not the first one at its place moves.
TriangleMesh with_gap(const GridSurface& soup, const SurfaceTopology& topology, double gap) {
  GridSurface open = soup;
  open.vertices[3 * topology.seams()->at(7).vertex] += static_cast<float>(gap);
  return mesh_of(open);
}

TEST(SeamCheck, HoldsUpToTheTolerance) {
  // Near the origin, so that 32-bit coordinates are fine enough.
  const GridSurface soup = unwelded(sphere(4, 5, 0.01));
  const SurfaceTopology topology(soup.faces, soup.vertices);
  SeamCheck check;
  EXPECT_TRUE(check.seams_hold(topology, mesh_of(soup)));
  EXPECT_TRUE(check.seams_hold(topology, with_gap(soup, topology, 0.99 * tolerance::kSeam)));
  EXPECT_FALSE(check.seams_hold(topology, with_gap(soup, topology, 1.01 * tolerance::kSeam)));
  EXPECT_FALSE(check.seams_hold(topology, with_gap(soup, topology, -0.002)));
  EXPECT_TRUE(check.seams_hold(topology, mesh_of(soup)));
}

TEST(SeamCheck, FollowsTheShapeAndTheTopology) {
  const GridSurface soup = unwelded(sphere(4, 5, 0.01));
  const SurfaceTopology topology(soup.faces, soup.vertices);
  TriangleMesh mesh = mesh_of(soup);
  SeamCheck check;
  EXPECT_TRUE(check.seams_hold(topology, mesh));
  mesh.move_vertices(with_gap(soup, topology, 1e-3).shared_vertices());
  EXPECT_FALSE(check.seams_hold(topology, mesh));
  EXPECT_FALSE(check.seams_hold(SurfaceTopology(topology), mesh)) << "a copy is the same";
  const SurfaceTopology later(soup.faces, mesh.vertices());
  EXPECT_TRUE(check.seams_hold(later, mesh));
  EXPECT_FALSE(check.seams_hold(topology, mesh));
}

/// What ended may leave its address to something else.
TEST(SeamCheck, AddressesThatAreUsedAgainAreNotMistaken) {
  const GridSurface soup = unwelded(sphere(4, 5, 0.01));
  SeamCheck check;
  for (int trial = 0; trial < 50; ++trial) {
    const auto topology = std::make_unique<SurfaceTopology>(soup.faces, soup.vertices);
    const bool holds = trial % 3 != 0;
    const TriangleMesh mesh = with_gap(soup, *topology, holds ? 0.0 : 1e-3);
    EXPECT_EQ(check.seams_hold(*topology, mesh), holds) << "trial " << trial;
  }
}

TEST(SeamCheck, ASurfaceWithoutSeamsHasNone) {
  GridSurface surface = sphere(4, 5, 0.01);
  const SurfaceTopology topology(surface.faces, surface.vertices);
  SeamCheck check;
  EXPECT_TRUE(check.seams_hold(topology, mesh_of(shaken(surface, 0.01F, 3))));
}

}  // namespace
}  // namespace organ_collision
