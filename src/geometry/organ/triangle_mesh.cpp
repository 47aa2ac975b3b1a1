#include "organ_collision/geometry/organ/triangle_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "geometry/concatenate.hpp"
#include "geometry/plausible_size.hpp"
#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {
namespace {

using Reason = MeshError::Reason;

template <typename... Parts>
void require_mesh(bool condition, Reason reason, const Parts&... text) {
  if (!condition) throw MeshError(reason, concatenate(text...));
}

/// Throws if a coordinate is not finite or too large. The message names the first bad coordinate.
void check_coordinates(const std::vector<float>& vertices) {
  const auto bad = std::find_if_not(vertices.begin(), vertices.end(),
                                    [](float coordinate) { return is_in_range(coordinate); });
  if (bad == vertices.end()) return;
  const auto index = static_cast<std::size_t>(bad - vertices.begin());
  require_mesh(false, std::isfinite(*bad) ? Reason::kTooFar : Reason::kNotFinite, "xyz"[index % 3],
               " of vertex ", index / 3, " is ", *bad, "; coordinates must be finite and within ",
               tolerance::kFarthest, " m");
}

void check_sizes(std::size_t coordinates, std::size_t indices, const MeshLimits& limits) {
  require_mesh(coordinates % 3 == 0, Reason::kSize, coordinates,
               " vertex coordinates; must be a multiple of three");
  require_mesh(indices % 3 == 0, Reason::kSize, indices,
               " triangle indices; must be a multiple of three");
  require_mesh(indices > 0, Reason::kNoTriangles, coordinates / 3,
               " vertices but no triangles; a mesh has at least one");
  require_mesh(indices / 3 <= limits.max_faces, Reason::kTooManyFaces, indices / 3,
               " faces; at most ", limits.max_faces, " are allowed");
  require_mesh(coordinates / 3 <= 3 * limits.max_faces, Reason::kTooManyVertices, coordinates / 3,
               " vertices; at most ", 3 * limits.max_faces, " are allowed");
}

std::vector<FaceIndices> make_faces(const std::vector<std::uint32_t>& triangles,
                                    std::size_t vertex_count) {
  std::vector<FaceIndices> faces(triangles.size() / 3);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    require_mesh(triangles[i] < vertex_count, Reason::kIndex, "face ", i / 3, " refers to vertex ",
                 triangles[i], " of ", vertex_count, "; the first is 0");
    faces[i / 3][i % 3] = triangles[i];
  }
  return faces;
}

}  // namespace

TriangleMesh::TriangleMesh(SharedVertices vertices, const std::vector<std::uint32_t>& triangles,
                           std::uint32_t topology, const MeshLimits& limits)
    : vertices_(std::move(vertices)) {
  check_sizes(vertices_->size(), triangles.size(), limits);
  std::vector<FaceIndices> faces = make_faces(triangles, vertex_count());
  check_coordinates(*vertices_);
  FaceClusters clusters(faces, *vertices_);
  topology_ = std::make_shared<Topology>(Topology{topology, std::move(faces), std::move(clusters)});
  boxes_.refit(topology_->clusters, *vertices_);
}

void TriangleMesh::move_vertices(SharedVertices vertices) {
  require_mesh(vertices->size() == vertices_->size(), Reason::kSize, vertices->size(),
               " vertex coordinates; this topology has ", vertices_->size());
  // Fitting the boxes also shows whether all coordinates are legal. A second pass finds the illegal
  // coordinate, if there is one.
  const bool finite = spare_boxes_.refit(topology_->clusters, *vertices);
  const Eigen::AlignedBox3f& box = spare_boxes_.all();
  if (!finite || !is_in_range(box.min().cast<double>()) || !is_in_range(box.max().cast<double>())) {
    check_coordinates(*vertices);
  }
  std::swap(boxes_, spare_boxes_);
  vertices_ = std::move(vertices);
}

bool TriangleMesh::has_triangles(const std::vector<std::uint32_t>& triangles) const {
  return triangles.size() == 3 * face_count() &&
         std::memcmp(triangles.data(), faces().data(), triangles.size() * sizeof(triangles[0])) ==
             0;
}

}  // namespace organ_collision
