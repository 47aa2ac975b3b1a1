#include "organ_collision/geometry/organ/triangle_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/concatenate.hpp"
#include "geometry/coordinate_range.hpp"
#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {
namespace {

using Reason = MeshError::Reason;

/// Throws if a coordinate is not finite or too large. The message names the first bad coordinate.
void check_coordinates(const std::vector<float>& vertices) {
  const auto bad = std::find_if_not(vertices.begin(), vertices.end(),
                                    [](float coordinate) { return is_in_range(coordinate); });
  if (bad == vertices.end()) return;
  const auto index = static_cast<std::size_t>(bad - vertices.begin());
  throw MeshError(
      std::isfinite(*bad) ? Reason::kTooFar : Reason::kNotFinite,
      concatenate("xyz"[index % 3], " of vertex ", index / 3, " is ", *bad,
                  "; coordinates must be finite and within ", tolerance::kFarthest, " m"));
}

void check_sizes(std::size_t coordinates, std::size_t indices, const MeshLimits& limits) {
  if (coordinates % 3 != 0) {
    throw MeshError(Reason::kSize, std::to_string(coordinates) +
                                       " vertex coordinates; must be a multiple of three");
  }
  if (indices % 3 != 0) {
    throw MeshError(Reason::kSize,
                    std::to_string(indices) + " triangle indices; must be a multiple of three");
  }
  if (indices == 0) {
    throw MeshError(
        Reason::kNoTriangles,
        std::to_string(coordinates / 3) + " vertices but no triangles; a mesh has at least one");
  }
  if (indices / 3 > limits.max_faces) {
    throw MeshError(Reason::kTooManyFaces, std::to_string(indices / 3) + " faces; at most " +
                                               std::to_string(limits.max_faces) + " are allowed");
  }
  if (coordinates / 3 > 3 * limits.max_faces) {
    throw MeshError(Reason::kTooManyVertices,
                    std::to_string(coordinates / 3) + " vertices; at most " +
                        std::to_string(3 * limits.max_faces) + " are allowed");
  }
}

std::vector<FaceIndices> make_faces(const std::vector<std::uint32_t>& triangles,
                                    std::size_t vertex_count) {
  std::vector<FaceIndices> faces(triangles.size() / 3);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (triangles[i] >= vertex_count) {
      throw MeshError(Reason::kIndex, "face " + std::to_string(i / 3) + " refers to vertex " +
                                          std::to_string(triangles[i]) + " of " +
                                          std::to_string(vertex_count) + "; the first is 0");
    }
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
  if (vertices->size() != vertices_->size()) {
    throw MeshError(Reason::kSize, std::to_string(vertices->size()) +
                                       " vertex coordinates; this topology has " +
                                       std::to_string(vertices_->size()));
  }
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
  if (triangles.size() != 3 * face_count()) return false;
  const std::uint32_t* next = triangles.data();
  for (const FaceIndices& face : faces()) {
    if (face[0] != next[0] || face[1] != next[1] || face[2] != next[2]) return false;
    next += 3;
  }
  return true;
}

}  // namespace organ_collision
