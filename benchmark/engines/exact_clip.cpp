#include "exact_clip.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace organ_collision::bench {
namespace {

using Eigen::Vector3d;

double excess(const HalfSpace& half_space, const Vector3d& point) {
  return half_space.normal.dot(point) - half_space.offset;
}

/// A convex polygon with few corners. Clipping to a half-space adds at most one corner.
class Polygon {
 public:
  void add(const Vector3d& point) { now_[size_++] = point; }
  const Vector3d* begin() const { return now_; }
  const Vector3d* end() const { return now_ + size_; }
  bool is_empty() const { return size_ == 0; }

  // Sutherland and Hodgman 1974.
  void clip(const HalfSpace& half_space) {
    if (is_empty()) return;
    std::swap(now_, then_);
    const std::size_t count = size_;
    size_ = 0;
    const Vector3d* from = &then_[count - 1];
    double from_excess = excess(half_space, *from);
    for (const Vector3d* to = then_; to != then_ + count; from = to++) {
      const double to_excess = excess(half_space, *to);
      if ((from_excess < 0.0 && to_excess > 0.0) || (from_excess > 0.0 && to_excess < 0.0)) {
        add(*from + (*to - *from) * (from_excess / (from_excess - to_excess)));
      }
      if (to_excess <= 0.0) add(*to);
      from_excess = to_excess;
    }
  }

 private:
  std::array<std::array<Vector3d, 48>, 2> corners_;
  Vector3d *now_ = corners_[0].data(), *then_ = corners_[1].data();
  std::size_t size_ = 0;
};

std::array<HalfSpace, 6> half_spaces_of(const Eigen::AlignedBox3d& box) {
  std::array<HalfSpace, 6> half_spaces;
  for (int axis = 0; axis < 3; ++axis) {
    half_spaces[2 * axis] = {Vector3d::Unit(axis), box.max()[axis]};
    half_spaces[2 * axis + 1] = {-Vector3d::Unit(axis), -box.min()[axis]};
  }
  return half_spaces;
}

}  // namespace

Eigen::AlignedBox3d box_within_organ(const VolumeQuery& query) {
  const std::array<HalfSpace, 6> organ = half_spaces_of(query.organ);
  Eigen::AlignedBox3d box;
  for (const std::vector<int>& side : query.solid.sides) {
    Polygon polygon;
    for (const int corner : side) polygon.add(query.solid.corners[corner]);
    for (const HalfSpace& half_space : organ) polygon.clip(half_space);
    for (const Vector3d& point : polygon) box.extend(point);
  }
  for (int i = 0; i < 8; ++i) {
    const Vector3d corner = query.organ.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
    const auto holds = [&](const HalfSpace& half_space) {
      return excess(half_space, corner) <= 0.0;
    };
    if (std::all_of(query.half_spaces.begin(), query.half_spaces.end(), holds)) box.extend(corner);
  }
  return box;
}

bool meets(const Triangle& face, const std::vector<HalfSpace>& half_spaces) {
  std::array<std::uint32_t, 3> outside = {0, 0, 0};
  for (std::size_t k = 0; k < half_spaces.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      outside[i] |= static_cast<std::uint32_t>(excess(half_spaces[k], face[i]) > 0.0) << k;
    }
  }
  if (outside[0] & outside[1] & outside[2]) return false;
  if (outside[0] == 0 || outside[1] == 0 || outside[2] == 0) return true;

  Polygon polygon;
  for (const Vector3d& corner : face) polygon.add(corner);
  const std::uint32_t crossed = outside[0] | outside[1] | outside[2];
  for (std::size_t k = 0; k < half_spaces.size() && !polygon.is_empty(); ++k) {
    if (crossed >> k & 1U) polygon.clip(half_spaces[k]);
  }
  return !polygon.is_empty();
}

void keep_faces_that_meet(const VolumeQuery& query, const OrganSurface& organ,
                          const std::vector<float>& vertices, std::vector<std::uint32_t>& faces) {
  const auto misses = [&](std::uint32_t face) {
    return !meets(corners(organ, vertices, face), query.half_spaces);
  };
  faces.erase(std::remove_if(faces.begin(), faces.end(), misses), faces.end());
  std::sort(faces.begin(), faces.end());
}

}  // namespace organ_collision::bench
