#include "face_search.hpp"

#include <limits>
#include <utility>

namespace organ_collision {
namespace {

using Eigen::Array4f;

/// [1] The allowance for rounding, as a share of the largest coordinates: about ten operations in
/// 32 bits lead to a squared distance, each with a relative error of 2^-24.
constexpr double kRounding = 2e-6;

Array4f padded(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), 0.0F};
}

}  // namespace

void FaceSearch::start(const OrganMotion& organ, const OrientedBox& box) {
  organ_.emplace(organ);
  center_ = padded(box.center);
  half_size_ = padded(box.half_size);
  for (Eigen::Index i = 0; i < 3; ++i) rows_[i] = padded(box.axes.row(i));
  groups_.clear();
  placed_.resize(std::max(placed_.size(), organ.after().vertex_count()));
  block_is_placed_.assign(clusters().block_count(), 0);
  slack_ = kRounding *
           (organ.extent(box.center) + box.center.cwiseAbs().maxCoeff() + box.half_size.maxCoeff());
}

/// Ranks up to kGroup groups of a level, from the group `begin` on.
void FaceSearch::rank_groups(std::uint32_t level, std::size_t begin, float squared_bound) {
  const std::vector<Box>& after = organ_->after().block_boxes().groups(level);
  const std::vector<Box>& before = organ_->boxes_before().groups(level);
  const std::size_t end = std::min(begin + FaceClusters::kGroup, clusters().group_count(level));
  for (std::size_t group = begin; group < end; ++group) {
    const Box box = after[group].join(before[group]);
    push({squared_distance(box), static_cast<std::uint32_t>(group), level}, squared_bound, groups_);
  }
}

void FaceSearch::rank_blocks(std::uint32_t section, float squared_bound) {
  blocks_.clear();
  const auto count = static_cast<std::uint32_t>(clusters().block_count());
  const std::uint32_t begin = section * FaceClusters::kGroup;
  const std::uint32_t end = std::min<std::uint32_t>(begin + FaceClusters::kGroup, count);
  for (std::uint32_t block = begin; block < end; ++block) {
    push({squared_distance(box_around(block)), block, 0}, squared_bound, blocks_);
  }
}

void FaceSearch::place_vertices(std::uint32_t block) {
  const auto in_box = [&](const TriangleMesh& shape, std::uint32_t vertex) {
    const float* const xyz = &shape.vertices()[3 * std::size_t{vertex}];
    return Array4f(rows_[0] * (xyz[0] - center_[0]) + rows_[1] * (xyz[1] - center_[1]) +
                   rows_[2] * (xyz[2] - center_[2]));
  };
  for (const std::uint32_t part : clusters().blocks(block)) {
    if (std::exchange(block_is_placed_[part], 1) != 0) continue;
    const std::uint32_t* const vertices = clusters().vertices(part);
    for (std::size_t i = 0; i < FaceClusters::kBlock; ++i) {
      const Array4f after = in_box(organ_->after(), vertices[i]);
      const Array4f before = organ_->rests() ? after : in_box(organ_->before(), vertices[i]);
      placed_[vertices[i]] = {after.min(before), after.max(before)};
    }
  }
}

void FaceSearch::push(const Ranked& ranked, float squared_bound, Ranking& ranking) {
  if (!(ranked.squared_distance <= squared_bound)) return;
  ranking.push_back(ranked);
  std::push_heap(ranking.begin(), ranking.end(), is_farther);
}

std::optional<FaceSearch::Ranked> FaceSearch::pop_nearest(Ranking& ranking, float squared_bound) {
  if (ranking.empty() || ranking.front().squared_distance > squared_bound) return std::nullopt;
  std::pop_heap(ranking.begin(), ranking.end(), is_farther);
  const Ranked nearest = ranking.back();
  ranking.pop_back();
  return nearest;
}

std::size_t FaceSearch::faces_left(float squared_bound) const {
  std::size_t count = 0;
  const auto add = [&](const Ranked& ranked, std::size_t begin, std::size_t end) {
    if (ranked.squared_distance > squared_bound) return;
    end = std::min(end, clusters().block_count());
    const auto faces = clusters().faces(end - 1).end() - clusters().faces(begin).begin();
    count += static_cast<std::size_t>(faces);
  };
  for (const Ranked& block : blocks_) add(block, block.index, block.index + 1);
  for (const Ranked& group : groups_) {
    std::size_t blocks = FaceClusters::kGroup;  // of a section
    for (std::uint32_t level = 0; level < group.level; ++level) blocks *= FaceClusters::kGroup;
    add(group, group.index * blocks, (group.index + 1) * blocks);
  }
  return count;
}

/// A box that contains the faces of a block's cluster (see FaceClusters) during the whole motion:
/// it joins the boxes of all blocks that hold a vertex of these faces. Empty if the cluster has no
/// faces.
FaceSearch::Box FaceSearch::box_around(std::uint32_t block) const {
  const std::vector<Box>& after = organ_->after().block_boxes().blocks();
  const std::vector<Box>& before = organ_->boxes_before().blocks();
  constexpr float kMost = std::numeric_limits<float>::max();
  Box box{Array4f::Constant(kMost), Array4f::Constant(-kMost)};
  for (const std::uint32_t part : clusters().blocks(block)) {
    box = box.join(after[part]).join(before[part]);
  }
  return box;
}

/// [m^2] A lower bound of the squared distance from the search's box; infinite for an empty box.
float FaceSearch::squared_distance(const Box& box) const {
  if (box.min[0] > box.max[0]) return std::numeric_limits<float>::infinity();
  const Array4f middle = 0.5F * box.min + 0.5F * box.max - center_;
  const Array4f half = 0.5F * box.max - 0.5F * box.min;
  Array4f center = Array4f::Zero(), spread = half_size_;
  for (Eigen::Index i = 0; i < 3; ++i) {
    center += rows_[i] * middle[i];
    spread += rows_[i].abs() * half[i];
  }
  return (center.abs() - spread).max(0.0F).square().sum();
}

}  // namespace organ_collision
