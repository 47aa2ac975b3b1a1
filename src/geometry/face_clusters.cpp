#include "organ_collision/geometry/face_clusters.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <numeric>

namespace organ_collision {
namespace {

constexpr std::uint32_t kBlock = FaceClusters::kBlockSize;

/// Spreads ten bits to every third one.
std::uint32_t spread(std::uint32_t bits) {
  bits = (bits | (bits << 16)) & 0x030000FFU;
  bits = (bits | (bits << 8)) & 0x0300F00FU;
  bits = (bits | (bits << 4)) & 0x030C30C3U;
  return (bits | (bits << 2)) & 0x09249249U;
}

/// The vertices along a Morton curve through 1024 cells a side.
std::vector<std::uint32_t> morton_order(const std::vector<float>& vertices) {
  const auto count = static_cast<Eigen::Index>(vertices.size() / 3);
  const Eigen::Map<const Eigen::Matrix3Xf> points(vertices.data(), 3, count);
  const Eigen::Vector3d low = points.rowwise().minCoeff().cast<double>();
  const Eigen::Vector3d size = points.rowwise().maxCoeff().cast<double>() - low;
  const double cells = size.maxCoeff() > 0.0 ? 1023.0 / size.maxCoeff() : 0.0;

  std::vector<std::uint64_t> keyed(static_cast<std::size_t>(count));
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Vector3d cell = (points.col(i).cast<double>() - low) * cells;
    const std::uint64_t key = spread(static_cast<std::uint32_t>(cell.x())) |
                              spread(static_cast<std::uint32_t>(cell.y())) << 1 |
                              spread(static_cast<std::uint32_t>(cell.z())) << 2;
    keyed[static_cast<std::size_t>(i)] = key << 32 | static_cast<std::uint64_t>(i);
  }
  std::sort(keyed.begin(), keyed.end());
  return {keyed.begin(), keyed.end()};
}

}  // namespace

FaceClusters::FaceClusters(const std::vector<FaceIndices>& faces,
                           const std::vector<float>& vertices)
    : vertex_count_(vertices.size() / 3) {
  std::vector<std::uint32_t> place(vertex_count_);
  std::iota(place.begin(), place.end(), 0U);
  group(faces, place);
  find_blocks(faces, place);

  // In a coherent order a cluster's faces lie in its own block and a few beside it; in a shuffled
  // one every other vertex is in a block of its own.
  constexpr std::size_t kCoherent = 12;
  if (blocks_.size() <= kCoherent * count()) return;
  order_ = morton_order(vertices);
  for (std::uint32_t i = 0; i < order_.size(); ++i) place[order_[i]] = i;
  group(faces, place);
  find_blocks(faces, place);
}

/// Sorts the faces by the block of their first vertex; counting sort keeps rising numbers.
void FaceClusters::group(const std::vector<FaceIndices>& faces, const Numbers& place) {
  const auto home = [&](const FaceIndices& face) {
    return std::min({place[face[0]], place[face[1]], place[face[2]]}) / kBlock;
  };
  face_begin_.assign(block_count() + 1, 0);
  for (const FaceIndices& face : faces) ++face_begin_[home(face) + 1];
  std::partial_sum(face_begin_.begin(), face_begin_.end(), face_begin_.begin());
  faces_.resize(faces.size());
  Numbers next(face_begin_.begin(), face_begin_.end() - 1);
  for (std::uint32_t i = 0; i < faces.size(); ++i) faces_[next[home(faces[i])]++] = i;
  // Blocks that are no face's first leave empty runs behind; they are no clusters.
  face_begin_.erase(std::unique(face_begin_.begin(), face_begin_.end()), face_begin_.end());
}

void FaceClusters::find_blocks(const std::vector<FaceIndices>& faces, const Numbers& place) {
  constexpr std::uint32_t kNone = ~0U;
  Numbers found_for(block_count(), kNone);
  blocks_.clear();
  block_begin_.assign(1, 0);
  for (std::uint32_t cluster = 0; cluster < count(); ++cluster) {
    for (const std::uint32_t face : this->faces(cluster)) {
      for (const std::uint32_t vertex : faces[face]) {
        const std::uint32_t block = place[vertex] / kBlock;
        if (found_for[block] == cluster) continue;
        found_for[block] = cluster;
        blocks_.push_back(block);
      }
    }
    block_begin_.push_back(static_cast<std::uint32_t>(blocks_.size()));
  }
}

}  // namespace organ_collision
