#include "organ_collision/geometry/triangle_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace organ_collision {
namespace {

using Reason = MeshError::Reason;

bool all_finite(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
}

[[noreturn]] void refuse_not_finite(const std::vector<float>& vertices) {
  const auto bad =
      std::find_if_not(vertices.begin(), vertices.end(), [](float x) { return std::isfinite(x); });
  const auto index = static_cast<std::size_t>(bad - vertices.begin());
  throw MeshError(Reason::kNotFinite, std::string(1, "xyz"[index % 3]) + " of vertex " +
                                          std::to_string(index / 3) + " is " +
                                          std::to_string(*bad) + "; coordinates must be finite");
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

TriangleMesh::TriangleMesh(const std::vector<float>& vertices,
                           const std::vector<std::uint32_t>& triangles, std::uint32_t topology,
                           const MeshLimits& limits)
    : vertices_(vertices) {
  check_sizes(vertices.size(), triangles.size(), limits);
  std::vector<FaceIndices> faces = make_faces(triangles, vertices.size() / 3);
  if (!all_finite(vertices)) refuse_not_finite(vertices);
  FaceClusters clusters(faces, vertices);
  topology_ = std::make_shared<Topology>(Topology{topology, std::move(faces), std::move(clusters)});
  boxes_.refit(topology_->clusters, vertices_);
}

void TriangleMesh::move_vertices(const std::vector<float>& vertices) {
  if (vertices.size() != vertices_.size()) {
    throw MeshError(Reason::kSize, std::to_string(vertices.size()) +
                                       " vertex coordinates; this topology has " +
                                       std::to_string(vertices_.size()));
  }
  if (!spare_boxes_.refit(topology_->clusters, vertices)) refuse_not_finite(vertices);
  std::swap(boxes_, spare_boxes_);
  std::copy(vertices.begin(), vertices.end(), vertices_.begin());
}

double largest_displacement(const TriangleMesh& before, const TriangleMesh& now) {
  const auto count = static_cast<Eigen::Index>(now.vertex_count());
  const Eigen::Map<const Eigen::Matrix3Xf> from(before.vertices().data(), 3, count);
  const Eigen::Map<const Eigen::Matrix3Xf> to(now.vertices().data(), 3, count);
  return std::sqrt((to.cast<double>() - from.cast<double>()).colwise().squaredNorm().maxCoeff());
}

}  // namespace organ_collision
