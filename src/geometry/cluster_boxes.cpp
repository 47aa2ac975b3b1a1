#include "organ_collision/geometry/cluster_boxes.hpp"

#include <algorithm>
#include <cmath>

namespace organ_collision {
namespace {

using Eigen::Array3f;
using Eigen::Array4f;

constexpr std::size_t kBlock = FaceClusters::kBlockSize;

struct Bounds {
  Array3f min, max;
  float sum;  ///< finite if all coordinates are; may overflow otherwise too
};

/// Four vertices at a time: three vectors of four floats, x y z x, y z x y, z x y z.
Bounds bounds_of_full_block(const float* xyz) {
  using Vector = Eigen::Map<const Array4f>;
  Array4f min0 = Vector(xyz), min1 = Vector(xyz + 4), min2 = Vector(xyz + 8);
  Array4f max0 = min0, max1 = min1, max2 = min2;
  Array4f sum = min0 + min1 + min2;
  for (std::size_t i = 12; i < 3 * kBlock; i += 12) {
    const Array4f v0 = Vector(xyz + i), v1 = Vector(xyz + i + 4), v2 = Vector(xyz + i + 8);
    min0 = min0.min(v0), min1 = min1.min(v1), min2 = min2.min(v2);
    max0 = max0.max(v0), max1 = max1.max(v1), max2 = max2.max(v2);
    sum += v0 + v1 + v2;
  }
  Eigen::Array<float, 3, 4> min, max;
  min << Eigen::Map<const Array3f>(min0.data()), Array3f(min0[3], min1[0], min1[1]),
      Array3f(min1[2], min1[3], min2[0]), Array3f(min2[1], min2[2], min2[3]);
  max << Eigen::Map<const Array3f>(max0.data()), Array3f(max0[3], max1[0], max1[1]),
      Array3f(max1[2], max1[3], max2[0]), Array3f(max2[1], max2[2], max2[3]);
  return {min.rowwise().minCoeff(), max.rowwise().maxCoeff(), sum.sum()};
}

/// `point(i)` is the i-th vertex of the block.
template <typename Point>
Bounds bounds_of(std::size_t count, const Point& point) {
  Bounds bounds{point(0), point(0), point(0).sum()};
  for (std::size_t i = 1; i < count; ++i) {
    const Array3f p = point(i);
    bounds.min = bounds.min.min(p);
    bounds.max = bounds.max.max(p);
    bounds.sum += p.sum();
  }
  return bounds;
}

bool all_finite(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
}

}  // namespace

bool ClusterBoxes::refit(const FaceClusters& clusters, const std::vector<float>& vertices) {
  if (!fit_blocks(clusters, vertices)) return false;
  fit_clusters(clusters);
  return true;
}

bool ClusterBoxes::fit_blocks(const FaceClusters& clusters, const std::vector<float>& vertices) {
  block_min_.resize(clusters.block_count());
  block_max_.resize(clusters.block_count());
  const std::size_t vertex_count = vertices.size() / 3;
  const std::vector<std::uint32_t>& order = clusters.order();
  const auto vertex = [&](std::size_t i) {
    return Array3f(Eigen::Map<const Array3f>(&vertices[3 * i]));
  };
  float sum = 0.0F;
  for (std::size_t block = 0; block < clusters.block_count(); ++block) {
    const std::size_t begin = block * kBlock;
    const std::size_t count = std::min(kBlock, vertex_count - begin);
    const Bounds bounds =
        !order.empty() ? bounds_of(count, [&](std::size_t i) { return vertex(order[begin + i]); })
        : count == kBlock ? bounds_of_full_block(&vertices[3 * begin])
                          : bounds_of(count, [&](std::size_t i) { return vertex(begin + i); });
    block_min_[block] << bounds.min, 0.0F;
    block_max_[block] << bounds.max, 0.0F;
    sum += bounds.sum;
  }
  // A sum that is finite proves that all were; one that overflowed proves nothing.
  return std::isfinite(sum) || all_finite(vertices);
}

void ClusterBoxes::fit_clusters(const FaceClusters& clusters) {
  for (int axis = 0; axis < 3; ++axis) {
    min_[axis].resize(clusters.count());
    max_[axis].resize(clusters.count());
  }
  for (std::size_t cluster = 0; cluster < clusters.count(); ++cluster) {
    const FaceClusters::Range blocks = clusters.blocks(cluster);
    Array4f min = block_min_[*blocks.begin()], max = block_max_[*blocks.begin()];
    for (const std::uint32_t block : blocks) {
      min = min.min(block_min_[block]);
      max = max.max(block_max_[block]);
    }
    for (int axis = 0; axis < 3; ++axis) {
      min_[axis][cluster] = min[axis];
      max_[axis][cluster] = max[axis];
    }
  }
  Array4f min = block_min_.front(), max = block_max_.front();
  for (const Array4f& block : block_min_) min = min.min(block);
  for (const Array4f& block : block_max_) max = max.max(block);
  all_ = {min.head<3>().matrix(), max.head<3>().matrix()};
}

Eigen::AlignedBox3f ClusterBoxes::box(std::size_t cluster) const {
  return {Eigen::Vector3f(min_[0][cluster], min_[1][cluster], min_[2][cluster]),
          Eigen::Vector3f(max_[0][cluster], max_[1][cluster], max_[2][cluster])};
}

void ClusterBoxes::find_meeting(const std::vector<HalfSpace>& half_spaces,
                                const Eigen::Vector3d& origin,
                                std::vector<std::uint32_t>& clusters) const {
  // Blocks of clusters small enough to stay in the nearest cache while each half-space passes.
  constexpr std::size_t kChunk = 512;
  const std::size_t count = min_[0].size();
  const double largest =
      std::max<double>(all_.min().cwiseAbs().maxCoeff(), all_.max().cwiseAbs().maxCoeff());
  clusters.clear();
  for (std::size_t begin = 0; begin < count; begin += kChunk) {
    const auto size = static_cast<Eigen::Index>(std::min(kChunk, count - begin));
    Eigen::Array<float, Eigen::Dynamic, 1, 0, kChunk, 1> over =
        Eigen::ArrayXf::Constant(size, -1.0F);
    for (const HalfSpace& half_space : half_spaces) {
      const double offset = half_space.offset + half_space.normal.dot(origin);
      // Six roundings of terms up to the largest coordinate, and the offset's own.
      const double slack = 1e-6 * (largest + std::abs(offset));
      const Eigen::Vector3f normal = half_space.normal.cast<float>();
      const auto nearest = [&](int axis) {
        const std::vector<float>& side = normal[axis] > 0.0F ? min_[axis] : max_[axis];
        return normal[axis] * Eigen::Map<const Eigen::ArrayXf>(&side[begin], size);
      };
      over = over.max(nearest(0) + nearest(1) + nearest(2) - static_cast<float>(offset + slack));
    }
    for (Eigen::Index i = 0; i < size; ++i) {
      if (!(over[i] > 0.0F))
        clusters.push_back(static_cast<std::uint32_t>(begin) + static_cast<std::uint32_t>(i));
    }
  }
}

}  // namespace organ_collision
