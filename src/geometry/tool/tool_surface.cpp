#include "organ_collision/geometry/tool/tool_surface.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/concatenate.hpp"
#include "geometry/plausible_size.hpp"
#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using Reason = MeshError::Reason;

/// The largest number of faces in a leaf. To test boxes around fewer faces costs more than it
/// saves.
constexpr std::uint32_t kLeafFaces = 4;
/// If a node has at most this many faces, project_onto() goes through all their corners, and not
/// through the boxes below the node.
constexpr std::uint32_t kScannedFaces = 512;
/// The number of corners that are projected together, in vector registers.
constexpr Eigen::Index kRows = 8;

template <typename... Parts>
void require(bool condition, Reason reason, const Parts&... text) {
  if (!condition) throw MeshError(reason, concatenate(text...));
}

void check(const std::vector<Vector3d>& vertices, const std::vector<FaceIndices>& faces) {
  require(!faces.empty(), Reason::kNoTriangles, "has no triangle; at least one is needed");
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vector3d& v = vertices[i];
    require(is_in_range(v), v.allFinite() ? Reason::kTooFar : Reason::kNotFinite, "vertex ", i,
            " is at (", v.x(), ", ", v.y(), ", ", v.z(), "); must be finite and within ",
            tolerance::kFarthest, " m");
  }
  for (std::size_t i = 0; i < faces.size(); ++i) {
    for (const std::uint32_t corner : faces[i]) {
      require(corner < vertices.size(), Reason::kIndex, "face ", i, " names vertex ", corner,
              " of ", vertices.size());
    }
  }
}

/// Removes the vertices that no face uses.
void drop_unused(std::vector<Vector3d>& vertices, std::vector<FaceIndices>& faces) {
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number(vertices.size(), kUnused);
  std::vector<Vector3d> used;
  for (FaceIndices& face : faces) {
    for (std::uint32_t& corner : face) {
      if (number[corner] == kUnused) {
        number[corner] = static_cast<std::uint32_t>(used.size());
        used.push_back(vertices[corner]);
      }
      corner = number[corner];
    }
  }
  vertices.swap(used);
}

/// Sorts faces by the places of their corners, so that the tree does not depend on the caller's
/// order.
void sort_by_corners(const std::vector<Vector3d>& vertices, std::vector<FaceIndices>& faces) {
  const auto is_less = [&](const FaceIndices& a, const FaceIndices& b) {
    for (std::size_t corner = 0; corner < a.size(); ++corner) {
      const Vector3d &p = vertices[a[corner]], &q = vertices[b[corner]];
      if (p != q) {
        return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
      }
    }
    return false;
  };
  std::sort(faces.begin(), faces.end(), is_less);
}

/// The principal axes of the points, as orthonormal, right-handed columns.
Eigen::Matrix3d principal_axes(const std::vector<Vector3d>& points) {
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& point : points) mean += point / static_cast<double>(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vector3d& point : points) spread += (point - mean) * (point - mean).transpose();
  Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors();
  if (axes.determinant() < 0.0) axes.col(0) *= -1.0;
  return axes;
}

OrientedBox box_around(const std::vector<Vector3d>& points, const Eigen::Matrix3d& axes) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& point : points) box.extend(Vector3d(axes.transpose() * point));
  return {axes * box.center(), axes, 0.5 * box.sizes()};
}

}  // namespace

ToolSurface::ToolSurface(std::vector<Vector3d> vertices, std::vector<FaceIndices> faces)
    : vertices_(std::move(vertices)), faces_(std::move(faces)) {
  check(vertices_, faces_);
  sort_by_corners(vertices_, faces_);
  drop_unused(vertices_, faces_);
  build(0, static_cast<std::uint32_t>(faces_.size()));
  corner_lists_.resize(nodes_.size());
  std::vector<Vector3d> corners;
  list_corners(0, corners);
  corners_.resize(static_cast<Eigen::Index>(corners.size()), 3);
  for (Eigen::Index i = 0; i < corners_.rows(); ++i) {
    corners_.row(i) = corners[static_cast<std::size_t>(i)];
  }
}

/// Adds the node of the faces [begin, end) and, below it, its children. The faces are split at the
/// median of their centroids along the box's longest axis.
void ToolSurface::build(std::uint32_t begin, std::uint32_t end) {
  std::vector<Vector3d> corners;
  for (std::uint32_t face = begin; face < end; ++face) {
    for (const Vector3d& corner : triangle(face)) corners.push_back(corner);
  }
  const OrientedBox principal = box_around(corners, principal_axes(corners));
  const OrientedBox aligned = box_around(corners, Eigen::Matrix3d::Identity());
  const OrientedBox& box =
      principal.half_size.prod() < aligned.half_size.prod() ? principal : aligned;
  const std::size_t node = nodes_.size();
  nodes_.push_back({box, begin, end, 0});
  if (end - begin <= kLeafFaces) return;

  Eigen::Index longest = 0;
  box.half_size.maxCoeff(&longest);
  const Vector3d along = box.axes.col(longest);
  const auto place = [&](const FaceIndices& face) {
    return along.dot(vertices_[face[0]] + vertices_[face[1]] + vertices_[face[2]]);
  };
  const std::uint32_t half = begin + (end - begin) / 2;
  std::nth_element(faces_.begin() + begin, faces_.begin() + half, faces_.begin() + end,
                   [&](const auto& a, const auto& b) { return place(a) < place(b); });
  build(begin, half);
  nodes_[node].second = static_cast<std::uint32_t>(nodes_.size());
  build(half, end);
}

/// Lists the corners of the faces below a node. The highest nodes with at most kScannedFaces faces
/// have one list each.
void ToolSurface::list_corners(std::uint32_t node, std::vector<Vector3d>& corners) {
  const auto& [box, begin, end, second] = nodes_[node];
  if (end - begin > kScannedFaces) {
    list_corners(node + 1, corners);
    return list_corners(second, corners);
  }
  std::vector<std::uint32_t> used;
  for (std::uint32_t face = begin; face < end; ++face) {
    used.insert(used.end(), faces_[face].begin(), faces_[face].end());
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  corner_lists_[node].begin = static_cast<Eigen::Index>(corners.size());
  for (const std::uint32_t vertex : used) corners.push_back(vertices_[vertex]);
  while (corners.size() % kRows != 0) corners.push_back(corners.back());
  corner_lists_[node].end = static_cast<Eigen::Index>(corners.size());
}

ProjectionInterval ToolSurface::project_onto(const Vector3d& direction) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  ProjectionInterval interval = {kInfinity, -kInfinity};
  extend(interval, 0, direction);
  return interval;
}

/// Extends `interval` by the projections of the node's faces. A child is visited only if its box
/// reaches beyond the interval. The child that reaches farther comes first.
void ToolSurface::extend(ProjectionInterval& interval, std::uint32_t node,
                         const Vector3d& direction) const {
  const CornerList& list = corner_lists_[node];
  if (list.begin < list.end) {
    Eigen::Array<double, kRows, 1> low, high;
    low.setConstant(interval.low);
    high.setConstant(interval.high);
    for (Eigen::Index row = list.begin; row < list.end; row += kRows) {
      const auto corners = corners_.middleRows<kRows>(row).array();
      const Eigen::Array<double, kRows, 1> places = corners.col(0) * direction.x() +
                                                    corners.col(1) * direction.y() +
                                                    corners.col(2) * direction.z();
      low = low.min(places);
      high = high.max(places);
    }
    interval = {low.minCoeff(), high.maxCoeff()};
    return;
  }
  std::uint32_t children[] = {node + 1, nodes_[node].second};
  const auto high = [&](std::uint32_t child) { return nodes_[child].box.support_value(direction); };
  if (high(children[1]) > high(children[0])) std::swap(children[0], children[1]);
  for (const std::uint32_t child : children) {
    constexpr double kBoxRounding = 1e-12;  // Rounding may make a box too small by this.
    const double low = -nodes_[child].box.support_value(-direction);
    if (high(child) >= interval.high - kBoxRounding * std::abs(interval.high) ||
        low <= interval.low + kBoxRounding * std::abs(interval.low)) {
      extend(interval, child, direction);
    }
  }
}

}  // namespace organ_collision
