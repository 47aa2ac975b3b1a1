#include "organ_collision/geometry/organ/block_boxes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace organ_collision {
namespace {

using Box = BlockBoxes::Box;
using Eigen::Array4f;

constexpr std::size_t kGroup = FaceClusters::kGroup;

/// The smallest box around a box and a point.
inline Box join(const Box& a, const Array4f& b) { return {a.min.min(b), a.max.max(b)}; }

Box empty_box() {
  constexpr float kMost = std::numeric_limits<float>::max();
  return {Array4f::Constant(kMost), Array4f::Constant(-kMost)};
}

/// Loads a vertex as one vector. load() also reads the x of the next vertex, so the last vertex
/// needs load_last().
Array4f load(const float* xyz) { return Eigen::Map<const Array4f>(xyz); }
Array4f load_last(const float* xyz) { return {xyz[0], xyz[1], xyz[2], 0.0F}; }

/// The box around the first `count` vertices. Adds their coordinates to `sum`.
inline Box box_around(const float* xyz, std::size_t count, Array4f& sum) {
  Box box = empty_box();
  Array4f own_sum = Array4f::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    const Array4f vertex = load(xyz + 3 * i);
    box = join(box, vertex);
    own_sum += vertex;
  }
  sum += own_sum;
  return box;
}

/// Fits the boxes of blocks that are consecutive vertices. Iterates over the vertices in the
/// sender's order, because the boxes fit into the cache and the vertices may not. Returns the sum
/// of all coordinates.
float fit_blocks(const std::vector<float>& vertices, const std::vector<std::uint32_t>& block_of,
                 std::vector<Box>& blocks) {
  // The processor's own prefetching stops at the end of a page.
  constexpr std::size_t kAhead = 128, kBlock = FaceClusters::kBlock;
  const float* const xyz = vertices.data();
  const std::size_t last = vertices.size() / 3 - 1, last_block = last / kBlock;
  Array4f sum = Array4f::Zero();
  for (std::size_t i = 0; i < last_block; ++i) {
    const std::size_t begin = i * kBlock;
    __builtin_prefetch(xyz + 3 * std::min(begin + kAhead, last));
    blocks[block_of[i]] = box_around(xyz + 3 * begin, kBlock, sum);
  }
  const std::size_t begin = last_block * kBlock;
  const Array4f vertex = load_last(xyz + 3 * last);
  blocks[block_of[last_block]] = join(box_around(xyz + 3 * begin, last - begin, sum), vertex);
  return (sum + vertex).sum();
}

/// The same for blocks of any vertices.
float fit_vertices(const std::vector<float>& vertices, const std::vector<std::uint32_t>& block_of,
                   std::vector<Box>& blocks) {
  std::fill(blocks.begin(), blocks.end(), empty_box());
  const float* const xyz = vertices.data();
  const std::size_t last = vertices.size() / 3 - 1;
  Array4f sum = Array4f::Zero();
  for (std::size_t i = 0; i <= last; ++i) {
    const Array4f vertex = i < last ? load(xyz + 3 * i) : load_last(xyz + 3 * i);
    Box& box = blocks[block_of[i]];
    box = join(box, vertex);
    sum += vertex;
  }
  return sum.sum();
}

/// `count`, rounded up to a multiple of kGroup.
std::size_t padded(std::size_t count) { return (count + kGroup - 1) / kGroup * kGroup; }

/// The box around kGroup members of a group.
Box join_members(const std::vector<Box>& members, std::size_t group) {
  Box box = members[group * kGroup];
  for (std::size_t i = 1; i < kGroup; ++i) box = box.join(members[group * kGroup + i]);
  return box;
}

bool all_finite(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
}

}  // namespace

bool BlockBoxes::refit(const FaceClusters& clusters, const std::vector<float>& vertices) {
  blocks_.resize(clusters.block_count());
  const std::vector<std::uint32_t>& block_of = clusters.block_of_piece();
  const float sum = clusters.piece_size() == 1 ? fit_vertices(vertices, block_of, blocks_)
                                               : fit_blocks(vertices, block_of, blocks_);
  blocks_.resize(padded(blocks_.size()), empty_box());
  fit_groups(clusters);
  const Box all = join_members(groups_[clusters.level_count() - 1], 0);
  all_ = {all.min.head<3>().matrix(), all.max.head<3>().matrix()};
  // If the sum is finite, so are all coordinates. If it is not, it may merely have overflowed.
  return std::isfinite(sum) || all_finite(vertices);
}

void BlockBoxes::fit_groups(const FaceClusters& clusters) {
  groups_.resize(std::max(groups_.size(), clusters.level_count()));
  for (std::size_t level = 0; level < clusters.level_count(); ++level) {
    const std::vector<Box>& members = level == 0 ? blocks_ : groups_[level - 1];
    groups_[level].assign(padded(clusters.group_count(level)), empty_box());
    for (std::size_t group = 0; group < clusters.group_count(level); ++group) {
      groups_[level][group] = join_members(members, group);
    }
    if (level == 0) add_borders(clusters);
  }
}

/// Extends the boxes of the sections by their borders.
void BlockBoxes::add_borders(const FaceClusters& clusters) {
  for (std::size_t section = 0; section < clusters.group_count(0); ++section) {
    for (const std::uint32_t block : clusters.border(section)) {
      groups_[0][section] = groups_[0][section].join(blocks_[block]);
    }
  }
}

}  // namespace organ_collision
