#include "outcodes.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <utility>

namespace organ_collision {
namespace {

// Vector types of the compiler. Four floats fit the registers of every 64-bit processor.
constexpr std::size_t kLanes = 4;
using Lanes = float __attribute__((vector_size(sizeof(float) * kLanes)));
/// Outcodes, or results of comparisons: all bits of a lane are then equal.
using LaneCodes = std::int32_t __attribute__((vector_size(sizeof(float) * kLanes)));

/// The number of points or boxes that one loop processes together (a run): the vertices of a block,
/// or half of the members of a group.
constexpr std::size_t kRun = FaceClusters::kBlock;
static_assert(FaceClusters::kGroup % kRun == 0);

/// One value, or one outcode, for each point of a run.
using ValueRun = std::array<Lanes, kRun / kLanes>;
using CodeRun = std::array<LaneCodes, kRun / kLanes>;

/// The coordinates of a run of points [m].
struct PointRun {
  ValueRun x, y, z;
};

/// A run of boxes, each with its lowest and its highest corner.
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

/// A run of value(0), value(1) ...
template <typename Value>
ValueRun run_of(Value value) {
  ValueRun run;
  for (std::size_t i = 0; i < run.size(); ++i) run[i] = value(i);
  return run;
}

ValueRun between(const ValueRun& before, const ValueRun& after, float fraction) {
  return run_of([&](std::size_t i) { return before[i] + fraction * (after[i] - before[i]); });
}

/// The points at a fraction of their linear motion.
PointRun between(const PointRun& before, const PointRun& after, float fraction) {
  return {between(before.x, after.x, fraction), between(before.y, after.y, fraction),
          between(before.z, after.z, fraction)};
}

Lanes magnitude(const Lanes& low, const Lanes& high) { return high > -low ? high : -low; }

/// [m] For each box, the sum of the largest magnitudes of x, of y and of z in the box.
ValueRun magnitude(const BoxRun& boxes) {
  const auto& [low, high] = boxes;
  return run_of([&, &low = low, &high = high](std::size_t i) {
    return magnitude(low.x[i], high.x[i]) + magnitude(low.y[i], high.y[i]) +
           magnitude(low.z[i], high.z[i]);
  });
}

constexpr std::size_t kGroup = FaceClusters::kGroup;

// [1] Bounds of the rounding error of a dot product of a point and a unit normal in 32 bits, as
// shares of the sum of the magnitudes of the point's coordinates. The error is at most four
// roundings, and seven more for an interpolated point. The rest is a safety margin. See
// doc/theory/geometry.md, Outcodes and 32-bit clipping.
constexpr float kSlack = 8.0F / (1 << 24);
constexpr float kSlackBetween = 16.0F / (1 << 24);

BoxRun load_boxes(const BlockBoxes::Box* boxes) {
  return {load_points([&](std::size_t i) { return boxes[i].min.data(); }),
          load_points([&](std::size_t i) { return boxes[i].max.data(); })};
}

/// Loads vertices as boxes without extent.
BoxRun load_vertices(const TriangleMesh& shape, const std::uint32_t* vertices) {
  const float* const xyz = shape.vertices().data();
  const PointRun points =
      load_points([&](std::size_t i) { return xyz + std::size_t{3} * vertices[i]; });
  return {points, points};
}

BoxRun between(const BoxRun& before, const BoxRun& after, double fraction) {
  const auto time = static_cast<float>(fraction);
  return {between(before.low, after.low, time), between(before.high, after.high, time)};
}

}  // namespace

void Outcodes::assign(const ViewingVolume& volume, const OrganMotion& organ) {
  organ_.emplace(organ);
  planes_.clear();
  for (std::size_t i = 0; i < volume.half_space_count(); ++i) {
    const HalfSpace half_space = volume.half_space(i);
    const Eigen::Vector3f normal = half_space.normal.cast<float>();
    const double offset = half_space.offset + half_space.normal.dot(volume.origin());
    const double slack = kSlack * std::abs(offset);
    planes_.push_back({normal.x(), normal.y(), normal.z(), static_cast<float>(offset + slack)});
  }
  ++query_;
  group_codes_.resize(std::max(group_codes_.size(), clusters().level_count()));
  for (std::size_t level = 0; level < clusters().level_count(); ++level) {
    group_codes_[level].resize(boxes().groups(level).size());
  }
  block_codes_.resize(boxes().blocks().size());
  vertex_codes_.resize(organ.after().vertex_count());
  section_found_for_.resize(clusters().group_count(0));
  block_found_for_.resize(clusters().block_count());
  find_group_codes(clusters().level_count() - 1, 0);
}

/// Finds the outcodes of kGroup groups of a level, from the group `begin` on.
void Outcodes::find_group_codes(std::size_t level, std::size_t begin) {
  find_member_codes(&boxes().groups(level)[begin], &organ_->boxes_before().groups(level)[begin],
                    &group_codes_[level][begin]);
}

/// Whether all blocks that contain vertices of a block's cluster are outside the same half-space.
/// Finds the outcodes of these blocks, a section at a time.
bool Outcodes::cluster_is_outside(std::size_t block) {
  unsigned code = ~0U;
  for (const std::uint32_t part : clusters().blocks(block)) {
    find_block_codes(part / kGroup);
    code &= block_codes_[part];
    if (code == 0) return false;
  }
  return true;
}

/// Finds the outcodes of a section's blocks, unless this query has found them already.
void Outcodes::find_block_codes(std::size_t section) {
  if (std::exchange(section_found_for_[section], query_) == query_) return;
  const std::size_t begin = section * kGroup;
  find_member_codes(&boxes().blocks()[begin], &organ_->boxes_before().blocks()[begin],
                    &block_codes_[begin]);
}

/// Finds the outcodes of the kGroup members of a group. Their boxes begin at `after` for the
/// organ's later shape and at `before` for the earlier one.
void Outcodes::find_member_codes(const BlockBoxes::Box* after, const BlockBoxes::Box* before,
                                 Code* codes) const {
  for (std::size_t i = 0; i < kGroup; i += kRun) {
    find_codes([&] { return load_boxes(after + i); }, [&] { return load_boxes(before + i); },
               codes + i);
  }
}

/// Finds the outcodes of the vertices of a cluster's faces, which may be in several blocks. Each
/// block is looked at once in a query.
void Outcodes::add_vertices(std::size_t block) {
  for (const std::uint32_t part : clusters().blocks(block)) {
    if (std::exchange(block_found_for_[part], query_) == query_) continue;
    const std::uint32_t* const vertices = clusters().vertices(part);
    std::array<Code, kRun> codes;
    find_codes([&] { return load_vertices(organ_->after(), vertices); },
               [&] { return load_vertices(organ_->before(), vertices); }, codes.data());
    for (std::size_t i = 0; i < kRun; ++i) vertex_codes_[vertices[i]] = codes[i];
  }
}

/// Finds the outcodes of boxes that rest, or whose corners move linearly. A moving box is outside a
/// half-space all the time if it is outside at both ends of the organ's motion. `load_after` and
/// `load_before` give the boxes of the organ's later and earlier shape.
template <typename LoadAfter, typename LoadBefore>
void Outcodes::find_codes(LoadAfter load_after, LoadBefore load_before, Code* codes) const {
  // `slack` [m]: for each box, a bound of the rounding error along a normal.
  const auto codes_of = [&](const BoxRun& boxes, const ValueRun& slack) {
    const auto& [low, high] = boxes;
    CodeRun run{};
    std::int32_t bit = 1;
    for (const Plane& plane : planes_) {
      const ValueRun& x = plane.x > 0.0F ? low.x : high.x;
      const ValueRun& y = plane.y > 0.0F ? low.y : high.y;
      const ValueRun& z = plane.z > 0.0F ? low.z : high.z;
      for (std::size_t i = 0; i < run.size(); ++i) {
        run[i] |=
            (plane.x * x[i] + plane.y * y[i] + plane.z * z[i] - slack[i] > plane.offset) & bit;
      }
      bit *= 2;
    }
    return run;
  };
  const BoxRun after = load_after();
  CodeRun outside;
  if (organ_->rests()) {
    const ValueRun most = magnitude(after);
    outside = codes_of(after, run_of([&](std::size_t i) { return kSlack * most[i]; }));
  } else {
    const BoxRun before = load_before();
    const ValueRun a = magnitude(before), b = magnitude(after);
    const ValueRun slack =
        run_of([&](std::size_t i) { return kSlackBetween * (a[i] > b[i] ? a[i] : b[i]); });
    outside = codes_of(between(before, after, organ_->begin()), slack);
    const CodeRun at_finish = codes_of(between(before, after, organ_->finish()), slack);
    for (std::size_t i = 0; i < outside.size(); ++i) outside[i] &= at_finish[i];
  }
  for (std::size_t i = 0; i < outside.size(); ++i) {
    using LaneOfCodes = Code __attribute__((vector_size(sizeof(Code) * kLanes)));
    const auto lane = __builtin_convertvector(outside[i], LaneOfCodes);
    std::memcpy(codes + i * kLanes, &lane, sizeof lane);
  }
}

}  // namespace organ_collision
