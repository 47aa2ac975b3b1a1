#include "outcodes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace organ_collision {
namespace {

constexpr std::size_t kRun = FaceClusters::kRun;

// The compiler's own vectors, as wide as every 64-bit processor has them.
constexpr std::size_t kLanes = 4;
using Lanes = float __attribute__((vector_size(sizeof(float) * kLanes)));
using LaneCodes = std::int32_t __attribute__((vector_size(sizeof(float) * kLanes)));

}  // namespace

/// Coordinates of a run of points [m].
struct Outcodes::Points {
  using Run = std::array<Lanes, kRun / kLanes>;
  Run x, y, z;

  /// `xyz(i)` points to the coordinates of point i.
  template <typename Coordinates>
  explicit Points(Coordinates xyz) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      const float* const a = xyz(kLanes * i);
      const float* const b = xyz(kLanes * i + 1);
      const float* const c = xyz(kLanes * i + 2);
      const float* const d = xyz(kLanes * i + 3);
      x[i] = Lanes{a[0], b[0], c[0], d[0]};
      y[i] = Lanes{a[1], b[1], c[1], d[1]};
      z[i] = Lanes{a[2], b[2], c[2], d[2]};
    }
  }
};

/// Of boxes between `low` and `high`; points are boxes without extent.
void Outcodes::find_run(const Points& low, const Points& high, Code* codes) const {
  std::array<LaneCodes, kRun / kLanes> all{};
  std::int32_t bit = 1;
  for (const Plane& plane : planes_) {
    const Points::Run& x = plane.x > 0.0F ? low.x : high.x;
    const Points::Run& y = plane.y > 0.0F ? low.y : high.y;
    const Points::Run& z = plane.z > 0.0F ? low.z : high.z;
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i] |= (plane.x * x[i] + plane.y * y[i] + plane.z * z[i] > plane.offset) & bit;
    }
    bit *= 2;
  }
  for (std::size_t i = 0; i < kRun; ++i) {
    codes[i] = static_cast<Code>(all[i / kLanes][i % kLanes]);
  }
}

void Outcodes::assign(const ViewingVolume& volume, const TriangleMesh& mesh) {
  mesh_ = &mesh;
  set_planes(volume);
  const std::size_t sections = mesh.block_boxes().sections().size();
  const std::size_t blocks = mesh.block_boxes().blocks().size();
  section_codes_.resize(sections);
  block_codes_.resize(blocks);
  vertex_codes_.resize(mesh.vertex_count());
  section_is_done_.assign(sections, false);
  block_is_done_.assign(blocks, false);
  for (std::size_t begin = 0; begin < sections; begin += kRun) {
    find_codes(mesh.block_boxes().sections(), begin, &section_codes_[begin]);
  }
}

void Outcodes::set_planes(const ViewingVolume& volume) {
  const Eigen::AlignedBox3f& box = mesh_->box();
  const double largest = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  planes_.clear();
  for (std::size_t i = 0; i < volume.half_space_count(); ++i) {
    const HalfSpace half_space = volume.half_space(i);
    const Eigen::Vector3f normal = half_space.normal.cast<float>();
    const double offset = half_space.offset + half_space.normal.dot(volume.origin());
    // Six roundings of terms up to the largest coordinate, and the offset's own.
    const double slack = 1e-6 * (largest + std::abs(offset));
    planes_.push_back({normal.x(), normal.y(), normal.z(), static_cast<float>(offset + slack)});
  }
}

void Outcodes::add_blocks(std::size_t section) {
  for (const std::uint32_t part : mesh_->clusters().sections(section)) {
    if (std::exchange(section_is_done_[part], true)) continue;
    find_codes(mesh_->block_boxes().blocks(), part * kRun, &block_codes_[part * kRun]);
  }
}

void Outcodes::add_vertices(std::size_t block) {
  for (const std::uint32_t part : mesh_->clusters().blocks(block)) {
    if (!std::exchange(block_is_done_[part], true)) find_vertex_codes(part);
  }
}

/// Of a run of boxes.
void Outcodes::find_codes(const std::vector<BlockBoxes::Box>& boxes, std::size_t begin,
                          Code* codes) const {
  const Points low([&](std::size_t i) { return boxes[begin + i].min.data(); });
  const Points high([&](std::size_t i) { return boxes[begin + i].max.data(); });
  find_run(low, high, codes);
}

void Outcodes::find_vertex_codes(std::size_t block) {
  const float* const xyz = mesh_->vertices().data();
  const std::uint32_t* const vertices = mesh_->clusters().vertices(block);
  const Points points([&](std::size_t i) { return xyz + std::size_t{3} * vertices[i]; });
  std::array<Code, kRun> codes;
  find_run(points, points, codes.data());
  for (std::size_t i = 0; i < kRun; ++i) vertex_codes_[vertices[i]] = codes[i];
}

}  // namespace organ_collision
