#pragma once

#include <array>
#include <cstddef>

#include "geometry/lanes.hpp"
#include "organ_collision/geometry/organ/face_clusters.hpp"

namespace organ_collision {

/// The points, or boxes, that one loop processes together: the vertices of a block, or a part of a
/// group's members.
inline constexpr std::size_t kRun = FaceClusters::kBlock;
static_assert(FaceClusters::kGroup % kRun == 0);

/// One value, or one outcode, for each point of a run.
using ValueRun = std::array<Lanes, kRun / kLanes>;
using CodeRun = std::array<LaneCodes, kRun / kLanes>;

/// Coordinates of a run of points [m].
struct PointRun {
  ValueRun x, y, z;
};

/// A run of boxes; points are boxes without extent.
struct BoxRun {
  PointRun low, high;
};

/// Loads a run of points. `xyz(i)` points to the three coordinates of point i.
template <typename Coordinates>
PointRun load_points(Coordinates xyz) {
  PointRun run;
  for (std::size_t i = 0; i < run.x.size(); ++i) {
    const float* const a = xyz(kLanes * i);
    const float* const b = xyz(kLanes * i + 1);
    const float* const c = xyz(kLanes * i + 2);
    const float* const d = xyz(kLanes * i + 3);
    run.x[i] = Lanes{a[0], b[0], c[0], d[0]};
    run.y[i] = Lanes{a[1], b[1], c[1], d[1]};
    run.z[i] = Lanes{a[2], b[2], c[2], d[2]};
  }
  return run;
}

/// The points at a fraction of their linear motion.
PointRun between(const PointRun& before, const PointRun& after, float fraction);

/// [m] For each box, the sum over x, y and z of the largest magnitude of that coordinate in the
/// box.
ValueRun magnitude(const BoxRun& boxes);

/// Element by element, the greater value.
ValueRun greater(const ValueRun& a, const ValueRun& b);
ValueRun scaled(const ValueRun& values, float factor);

}  // namespace organ_collision
