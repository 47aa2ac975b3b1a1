#include "organ_collision/geometry/organ/block_boxes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace organ_collision {
namespace {

using Box = BlockBoxes::Box;
using Eigen::Array4f;

constexpr std::size_t kRun = FaceClusters::kRun;

inline Box join(const Box& a, const Box& b) { return {a.min.min(b.min), a.max.max(b.max)}; }
inline Box join(const Box& a, const Array4f& b) { return {a.min.min(b), a.max.max(b)}; }

Box empty_box() {
  constexpr float kMost = std::numeric_limits<float>::max();
  return {Array4f::Constant(kMost), Array4f::Constant(-kMost)};
}

/// Loads a vertex as one vector. load() also reads the x of the next vertex, so the last vertex
/// needs load_last().
Array4f load(const float* xyz) { return Eigen::Map<const Array4f>(xyz); }
Array4f load_last(const float* xyz) { return {xyz[0], xyz[1], xyz[2], 0.0F}; }

/// Fits the boxes of blocks that are runs of vertices. Returns the sum of all coordinates.
float fit_runs(const std::vector<float>& vertices, const std::vector<std::uint32_t>& block_of_run,
               std::vector<Box>& blocks) {
  // The processor's own prefetching stops at the end of a page.
  constexpr std::size_t kAhead = 128;
  const Box empty = empty_box();
  const float* const xyz = vertices.data();
  const std::size_t last = vertices.size() / 3 - 1;
  Array4f sum = Array4f::Zero();
  for (std::size_t run = 0; run < block_of_run.size(); ++run) {
    const std::size_t begin = run * kRun, end = std::min(begin + kRun, last);
    __builtin_prefetch(xyz + 3 * std::min(begin + kAhead, last));
    Box box = empty;
    Array4f run_sum = Array4f::Zero();
    for (std::size_t i = begin; i < end; ++i) {
      const Array4f vertex = load(xyz + 3 * i);
      box = join(box, vertex);
      run_sum += vertex;
    }
    blocks[block_of_run[run]] = box;
    sum += run_sum;
  }
  const Array4f vertex = load_last(xyz + 3 * last);
  Box& box = blocks[block_of_run.back()];
  box = join(box, vertex);
  return (sum + vertex).sum();
}

/// The same for blocks that are not runs. Iterates over the vertices, not over the blocks, because
/// the boxes fit into the cache and the vertices may not.
float fit_scattered(const std::vector<float>& vertices,
                    const std::vector<std::uint32_t>& block_of_vertex, std::vector<Box>& blocks) {
  std::fill(blocks.begin(), blocks.end(), empty_box());
  const float* const xyz = vertices.data();
  const std::size_t last = vertices.size() / 3 - 1;
  Array4f sum = Array4f::Zero();
  for (std::size_t i = 0; i <= last; ++i) {
    const Array4f vertex = i < last ? load(xyz + 3 * i) : load_last(xyz + 3 * i);
    Box& box = blocks[block_of_vertex[i]];
    box = join(box, vertex);
    sum += vertex;
  }
  return sum.sum();
}

std::size_t round_up(std::size_t count) { return (count + kRun - 1) / kRun * kRun; }

bool all_finite(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
}

}  // namespace

bool BlockBoxes::refit(const FaceClusters& clusters, const std::vector<float>& vertices) {
  blocks_.resize(round_up(clusters.block_count()), empty_box());
  // Boxes may be left from other clusters with more blocks.
  std::fill(blocks_.begin() + static_cast<std::ptrdiff_t>(clusters.block_count()), blocks_.end(),
            empty_box());
  sections_.resize(round_up(clusters.section_count()), empty_box());
  const float sum = clusters.block_of_run().empty()
                        ? fit_scattered(vertices, clusters.block_of_vertex(), blocks_)
                        : fit_runs(vertices, clusters.block_of_run(), blocks_);
  Box all = empty_box();
  for (std::size_t section = 0; section < clusters.section_count(); ++section) {
    Box box = blocks_[section * kRun];
    for (std::size_t i = 1; i < kRun; ++i) box = join(box, blocks_[section * kRun + i]);
    sections_[section] = box;
    all = join(all, box);
  }
  all_ = {all.min.head<3>().matrix(), all.max.head<3>().matrix()};
  // If the sum is finite, so are all coordinates. If it is not, it may merely have overflowed.
  return std::isfinite(sum) || all_finite(vertices);
}

}  // namespace organ_collision
