#include "region_clipper.hpp"

#include <algorithm>
#include <cmath>

#include "picking/gl/feedback.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector2d;

// Orders the corners of a convex polygon in the same sense as the face's corners. Removes
// duplicates.
void order_corners(std::vector<Vector2d>& corners) {
  const auto less = [](const Vector2d& a, const Vector2d& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  };
  std::sort(corners.begin(), corners.end(), less);
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  Vector2d centre = Vector2d::Zero();
  for (const Vector2d& corner : corners) centre += corner / static_cast<double>(corners.size());
  const auto angle = [&](const Vector2d& corner) {
    return std::atan2(corner.y() - centre.y(), corner.x() - centre.x());
  };
  std::sort(corners.begin(), corners.end(),
            [&](const Vector2d& a, const Vector2d& b) { return angle(a) < angle(b); });
}

}  // namespace

std::vector<Region> RegionClipper::clip(const ViewingVolume& volume, const TriangleMesh& mesh,
                                        const std::vector<std::uint32_t>& faces) {
  DrawList list;
  list.assign(volume, mesh, faces);
  const std::size_t size = draw_feedback(*context_, volume, list.vertices(), buffer_);
  std::vector<std::vector<Vector2d>> corners(faces.size());
  for_each_vertex(buffer_, size, [&](const FeedbackVertex& vertex) {
    corners[vertex.face()].push_back(vertex.barycentric());
  });

  std::vector<Region> regions(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    order_corners(corners[i]);
    const Triangle face = mesh.triangle(faces[i]);
    for (const Vector2d& corner : corners[i]) {
      regions[i].push_back((1 - corner.sum()) * face[0] + corner.x() * face[1] +
                           corner.y() * face[2]);
    }
  }
  return regions;
}

}  // namespace organ_collision
