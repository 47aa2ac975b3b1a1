#include "organ_collision/geometry/organ/face_clusters.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <numeric>
#include <utility>

#include "compact_order.hpp"

namespace organ_collision {
namespace {

constexpr std::uint32_t kNone = ~0U;

Eigen::Vector3f vertex(const std::vector<float>& vertices, std::size_t i) {
  return Eigen::Map<const Eigen::Vector3f>(&vertices[3 * i]);
}

/// Whether vertices that follow each other in the sender's order are neighbours in space: on
/// average over a sample, their distance is at most kFar times the length of an edge.
bool is_coherent(const std::vector<FaceIndices>& faces, const std::vector<float>& vertices) {
  constexpr std::size_t kMostSamples = 4096;
  constexpr double kFar = 4.0;
  const std::size_t count = vertices.size() / 3, samples = std::min(count, kMostSamples);
  double steps = 0.0, edges = 0.0;
  for (std::size_t i = 0; i < samples; ++i) {
    const std::size_t place = i * count / samples;
    const FaceIndices& face = faces[i * faces.size() / samples];
    const std::size_t next = std::min(place + 1, count - 1);
    steps += (vertex(vertices, next) - vertex(vertices, place)).norm();
    edges += (vertex(vertices, face[1]) - vertex(vertices, face[0])).norm();
  }
  return steps <= kFar * edges;
}

}  // namespace

FaceClusters::FaceClusters(const std::vector<FaceIndices>& faces,
                           const std::vector<float>& vertices)
    : piece_size_(is_coherent(faces, vertices) ? kBlock : 1) {
  order_pieces(vertices);
  Numbers block_of(vertices.size() / 3);
  for (std::uint32_t i = 0; i < order_.size(); ++i) block_of[order_[i]] = i / kBlock;
  sort_faces(faces, block_of);
  find_blocks(block_of);
  std::size_t count = block_count();
  do {
    count = (count + kGroup - 1) / kGroup;
    group_counts_.push_back(count);
  } while (count > kGroup);
  find_borders();
}

void FaceClusters::order_pieces(const std::vector<float>& vertices) {
  const auto last = static_cast<std::uint32_t>(vertices.size() / 3 - 1);
  const std::uint32_t size = piece_size_;
  block_of_piece_.resize(last / size + 1);
  order_.reserve(vertices.size() / 3 + kBlock);
  for (const std::uint32_t first : compact_order(vertices, size, kBlock / size)) {
    block_of_piece_[first / size] = static_cast<std::uint32_t>(order_.size() / kBlock);
    for (std::uint32_t i = 0; i < size; ++i) order_.push_back(std::min(first + i, last));
  }
  order_.resize((order_.size() + kBlock - 1) / kBlock * kBlock, order_.back());
}

/// Sorts the faces by their first block. Counting sort keeps the numbers within a cluster rising.
void FaceClusters::sort_faces(const std::vector<FaceIndices>& faces, const Numbers& block_of) {
  const auto home = [&](const FaceIndices& face) {
    return std::min({block_of[face[0]], block_of[face[1]], block_of[face[2]]});
  };
  face_begin_.assign(block_count() + 1, 0);
  for (const FaceIndices& face : faces) ++face_begin_[home(face) + 1];
  std::partial_sum(face_begin_.begin(), face_begin_.end(), face_begin_.begin());
  faces_.resize(faces.size());
  Numbers next(face_begin_.begin(), face_begin_.end() - 1);
  for (std::uint32_t i = 0; i < faces.size(); ++i) faces_[next[home(faces[i])]++] = {faces[i], i};
}

void FaceClusters::find_blocks(const Numbers& block_of) {
  Numbers found_for(block_count(), kNone);
  for (std::uint32_t cluster = 0; cluster < block_count(); ++cluster) {
    for (const Face& face : faces(cluster)) {
      for (const std::uint32_t corner : face.corners) {
        const std::uint32_t block = block_of[corner];
        if (std::exchange(found_for[block], cluster) != cluster) blocks_.all.push_back(block);
      }
    }
    blocks_.begin.push_back(static_cast<std::uint32_t>(blocks_.all.size()));
  }
}

void FaceClusters::find_borders() {
  Numbers found_for(block_count(), kNone);
  for (std::uint32_t section = 0; section < group_count(0); ++section) {
    const std::size_t end = std::min((section + 1) * kGroup, block_count());
    for (std::size_t block = section * kGroup; block < end; ++block) {
      for (const std::uint32_t part : blocks(block)) {
        const bool is_beyond = part / kGroup != section;
        if (is_beyond && std::exchange(found_for[part], section) != section) {
          borders_.all.push_back(part);
        }
      }
    }
    borders_.begin.push_back(static_cast<std::uint32_t>(borders_.all.size()));
  }
}

}  // namespace organ_collision
