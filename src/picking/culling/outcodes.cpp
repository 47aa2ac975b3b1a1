#include "outcodes.hpp"

#include <cmath>
#include <utility>

#include "point_run.hpp"

namespace organ_collision {
namespace {

constexpr std::size_t kRun = FaceClusters::kRun;

// [1] Bounds on the rounding error of a dot product with a unit normal in 32 bits, as shares of the
// sum of the magnitudes of the point's coordinates. The error is at most four roundings, and seven
// more for a point interpolated between two others. The rest is a safety margin. See
// doc/geometry.md, Outcodes and 32-bit clipping.
constexpr float kSlack = 8.0F / (1 << 24);
constexpr float kSlackBetween = 16.0F / (1 << 24);

BoxRun load_boxes(const std::vector<BlockBoxes::Box>& boxes, std::size_t begin) {
  return {load_points([&](std::size_t i) { return boxes[begin + i].min.data(); }),
          load_points([&](std::size_t i) { return boxes[begin + i].max.data(); })};
}

/// Vertices as boxes without extent.
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
  set_planes(volume);
  const std::size_t sections = boxes().sections().size();
  const std::size_t blocks = boxes().blocks().size();
  section_codes_.resize(sections);
  block_codes_.resize(blocks);
  vertex_codes_.resize(organ.after().vertex_count());
  section_is_done_.assign(sections, false);
  block_is_done_.assign(blocks, false);
  for (std::size_t begin = 0; begin < sections; begin += kRun) {
    find_codes(
        load_boxes(boxes().sections(), begin),
        [&] { return load_boxes(organ_->boxes_before().sections(), begin); },
        &section_codes_[begin]);
  }
}

void Outcodes::set_planes(const ViewingVolume& volume) {
  planes_.clear();
  for (std::size_t i = 0; i < volume.half_space_count(); ++i) {
    const HalfSpace half_space = volume.half_space(i);
    const Eigen::Vector3f normal = half_space.normal.cast<float>();
    const double offset = half_space.offset + half_space.normal.dot(volume.origin());
    const double slack = kSlack * std::abs(offset);
    planes_.push_back({normal.x(), normal.y(), normal.z(), static_cast<float>(offset + slack)});
  }
}

void Outcodes::add_blocks(std::size_t section) {
  for (const std::uint32_t part : clusters().sections(section)) {
    if (std::exchange(section_is_done_[part], true)) continue;
    const std::size_t begin = part * kRun;
    find_codes(
        load_boxes(boxes().blocks(), begin),
        [&] { return load_boxes(organ_->boxes_before().blocks(), begin); }, &block_codes_[begin]);
  }
}

void Outcodes::add_vertices(std::size_t block) {
  for (const std::uint32_t part : clusters().blocks(block)) {
    if (std::exchange(block_is_done_[part], true)) continue;
    const std::uint32_t* const vertices = clusters().vertices(part);
    std::array<Code, kRun> codes;
    find_codes(
        load_vertices(organ_->after(), vertices),
        [&] { return load_vertices(organ_->before(), vertices); }, codes.data());
    for (std::size_t i = 0; i < kRun; ++i) vertex_codes_[vertices[i]] = codes[i];
  }
}

/// Finds the outcodes of boxes that rest, or whose corners move linearly. A moving box is outside a
/// half-space all the time if it is outside at both ends of the organ's motion. `load_before()`
/// returns the boxes of the organ's earlier shape.
template <typename LoadBefore>
void Outcodes::find_codes(const BoxRun& after, LoadBefore load_before, Code* codes) const {
  CodeRun outside;
  if (organ_->rests()) {
    outside = find_codes(after, scaled(magnitude(after), kSlack));
  } else {
    const BoxRun before = load_before();
    const ValueRun slack = scaled(greater(magnitude(before), magnitude(after)), kSlackBetween);
    outside = find_codes(between(before, after, organ_->begin()), slack);
    const CodeRun at_finish = find_codes(between(before, after, organ_->finish()), slack);
    for (std::size_t i = 0; i < outside.size(); ++i) outside[i] &= at_finish[i];
  }
  for (std::size_t i = 0; i < kRun; ++i) {
    codes[i] = static_cast<Code>(outside[i / kLanes][i % kLanes]);
  }
}

/// `slack` [m]: a bound on the rounding error of each box along a normal.
CodeRun Outcodes::find_codes(const BoxRun& boxes, const ValueRun& slack) const {
  const auto& [low, high] = boxes;
  CodeRun codes{};
  std::int32_t bit = 1;
  for (const Plane& plane : planes_) {
    const ValueRun& x = plane.x > 0.0F ? low.x : high.x;
    const ValueRun& y = plane.y > 0.0F ? low.y : high.y;
    const ValueRun& z = plane.z > 0.0F ? low.z : high.z;
    for (std::size_t i = 0; i < codes.size(); ++i) {
      codes[i] |=
          (plane.x * x[i] + plane.y * y[i] + plane.z * z[i] - slack[i] > plane.offset) & bit;
    }
    bit *= 2;
  }
  return codes;
}

}  // namespace organ_collision
