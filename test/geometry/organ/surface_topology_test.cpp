#include "organ_collision/geometry/organ/surface_topology.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "geometry/organ/seam_check.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "test/closed_surfaces.hpp"

namespace organ_collision {
namespace {

using Place = std::array<float, 3>;
using Random = std::mt19937;

Place place(const GridSurface& surface, std::uint32_t vertex) {
  const float* const at = &surface.vertices[3 * vertex];
  return {at[0] + 0.0F, at[1] + 0.0F, at[2] + 0.0F};  // -0 becomes 0.
}

/// How often each directed edge occurs, between places.
std::map<std::pair<Place, Place>, int> directed_edges(const GridSurface& surface) {
  std::map<std::pair<Place, Place>, int> count;
  for (const FaceIndices& face : surface.faces) {
    for (std::size_t i = 0; i < 3; ++i) {
      ++count[{place(surface, face[i]), place(surface, face[(i + 1) % 3])}];
    }
  }
  return count;
}

/// The definition, with a map from places to counts.
std::size_t open_edges_by_definition(const GridSurface& surface) {
  const auto count = directed_edges(surface);
  std::set<std::pair<Place, Place>> open;
  for (const auto& [edge, times] : count) {
    const auto opposite = count.find({edge.second, edge.first});
    if (opposite != count.end() && opposite->second == times) continue;
    open.insert(std::minmax(edge.first, edge.second));
  }
  return open.size();
}

/// The flux of the field (0, 0, z) through the surface: by the divergence theorem, the volume.
double volume_by_flux(const GridSurface& surface) {
  double volume = 0.0;
  for (const FaceIndices& face : surface.faces) {
    std::array<std::array<double, 3>, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) p[i][k] = surface.vertices[3 * face[i] + k];
    }
    const double shadow =
        (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[2][0] - p[0][0]) * (p[1][1] - p[0][1]);
    volume += shadow / 2.0 * (p[0][2] + p[1][2] + p[2][2]) / 3.0;
  }
  return volume;
}

SurfaceTopology topology_of(const GridSurface& surface) {
  return {surface.faces, surface.vertices};
}

double volume_of(const GridSurface& surface) {
  return signed_volume(topology_of(surface), surface.faces, surface.vertices);
}

/// A tetrahedron that points outward, with a place for each of its corners.
GridSurface tetrahedron(Random& random) {
  std::uniform_real_distribution<float> coordinate(-0.3F, 0.7F);
  GridSurface solid;
  for (int i = 0; i < 4; ++i) {
    add_vertex(solid, {coordinate(random), coordinate(random), coordinate(random)});
  }
  solid.faces = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  if (volume_by_flux(solid) < 0.0) {
    for (FaceIndices& face : solid.faces) std::swap(face[1], face[2]);
  }
  return solid;
}

void expect_as_defined(const GridSurface& surface, const char* what) {
  const SurfaceTopology topology = topology_of(surface);
  const std::size_t open = open_edges_by_definition(surface);
  EXPECT_EQ(topology.open_edge_count(), open) << what;
  EXPECT_EQ(topology.is_closed(), open == 0) << what;
  const double volume = open == 0 ? volume_by_flux(surface) : 0.0;
  EXPECT_NEAR(volume_of(surface), volume, 1e-12 * (1.0 + std::abs(volume))) << what;
}

TEST(SurfaceTopology, WeldingFollowsTheDefinition) {
  Random random(11);
  std::uniform_int_distribution<int> coordinate(-2, 2);
  for (int trial = 0; trial < 50; ++trial) {
    GridSurface surface;
    for (int i = 0; i < 300; ++i) {
      const auto draw = [&] { return 0.1F * static_cast<float>(coordinate(random)); };
      add_vertex(surface, {draw(), draw(), draw()});
    }
    for (std::uint32_t i = 0; i < 300; i += 3) surface.faces.push_back({i, i + 1, i + 2});
    std::map<Place, std::uint32_t> first;
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < 300; ++i) {
      expected.push_back(first.emplace(place(surface, i), i).first->second);
    }
    EXPECT_EQ(topology_of(surface).welded(), expected) << "trial " << trial;
  }
}

TEST(SurfaceTopology, SeamsAreTheVerticesThatAreWeldedToOthers) {
  const GridSurface soup = shuffled(unwelded(torus(5, 7, 0.1, 0.2)), 8);
  const SurfaceTopology topology = topology_of(soup);
  std::vector<std::uint32_t> welded(soup.vertices.size() / 3);
  std::iota(welded.begin(), welded.end(), 0U);
  for (const SeamVertex& seam : *topology.seams()) {
    EXPECT_LT(seam.first, seam.vertex);
    welded[seam.vertex] = seam.first;
  }
  EXPECT_EQ(welded, topology.welded());
  EXPECT_EQ(topology.seams()->size(), 5U * 7U * 5U) << "each place has six vertices";
  const SurfaceTopology copy = topology;
  EXPECT_EQ(copy.seams(), topology.seams());
  EXPECT_TRUE(topology_of(torus(5, 7, 0.1, 0.2)).seams()->empty());
}

TEST(SurfaceTopology, ClosedSurfacesInAnyOrderAndAnyVertices) {
  Random random(5);
  for (int trial = 0; trial < 40; ++trial) {
    GridSurface surface = torus(7 + trial % 5, 11 + trial % 3, 0.13, 0.7 * trial);
    for (int i = 0; i < trial % 4; ++i) surface = joined(surface, tetrahedron(random));
    const double volume = volume_by_flux(surface);
    ASSERT_GT(volume, 0.0);
    const unsigned seed = static_cast<unsigned>(trial);
    for (const GridSurface& same :
         {surface, shuffled(surface, seed), unwelded(surface), shuffled(unwelded(surface), seed)}) {
      expect_as_defined(same, "closed");
      EXPECT_TRUE(topology_of(same).is_closed());
      EXPECT_NEAR(volume_of(same), volume, 1e-12);
      EXPECT_NEAR(volume_of(turned_over(same)), -volume, 1e-12);
    }
  }
}

/// Two vertices that were at one place in the mesh message count as one, wherever they are later.
TEST(SignedVolume, ADeformedMeshIsWeldedAsItsFirstShape) {
  Random random(3);
  const GridSurface first = tetrahedron(random);
  const GridSurface soup = unwelded(first);
  const SurfaceTopology topology = topology_of(soup);
  std::vector<float> later = soup.vertices;
  std::uniform_real_distribution<float> shift(-0.1F, 0.1F);
  for (float& coordinate : later) coordinate += shift(random);
  GridSurface welded{later, soup.faces};
  for (FaceIndices& face : welded.faces) face = topology.welded(face);
  const double volume = volume_by_flux(welded);
  EXPECT_GT(std::abs(volume), 1e-3);
  EXPECT_NEAR(signed_volume(topology, soup.faces, later), volume, 1e-12);
}

TriangleMesh mesh_of(const GridSurface& surface) { return {surface.vertices, surface.triangles()}; }

/// A vertex that is not the first one at its place moves.
TriangleMesh with_gap(const GridSurface& soup, const SurfaceTopology& topology, double gap) {
  GridSurface open = soup;
  open.vertices[3 * topology.seams()->at(7).vertex] += static_cast<float>(gap);
  return mesh_of(open);
}

// Near the origin, so that 32-bit coordinates are fine enough.
TEST(SeamCheck, FollowsTheShapeAndTheTopology) {
  const GridSurface soup = unwelded(sphere(4, 5, 0.01));
  const SurfaceTopology topology(soup.faces, soup.vertices);
  TriangleMesh mesh = mesh_of(soup);
  SeamCheck check;
  for (const double gap : {0.0, 0.99 * tolerance::kSeam, 1.01 * tolerance::kSeam, -0.002, 0.0}) {
    mesh.move_vertices(with_gap(soup, topology, gap).shared_vertices());
    const bool holds = std::abs(gap) < tolerance::kSeam;
    EXPECT_EQ(check.seams_hold(topology, mesh), holds) << gap;
    EXPECT_EQ(check.seams_hold(SurfaceTopology(topology), mesh), holds) << "a copy is the same";
    const SurfaceTopology later(soup.faces, mesh.vertices());
    EXPECT_TRUE(check.seams_hold(later, mesh));
    EXPECT_EQ(check.seams_hold(topology, mesh), holds);
  }
}

}  // namespace
}  // namespace organ_collision
