#include "organ_collision/geometry/organ/face_clusters.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace organ_collision {
namespace {

/// Some consecutive vertices, and the place [m] of the first one: sorting is faster if the place is
/// stored here and not looked up in the mesh.
struct Piece {
  Eigen::Vector3f place;
  std::uint32_t first_vertex;
};

void order(Piece* begin, Piece* end, std::ptrdiff_t together) {
  if (end - begin <= together) return;
  Eigen::AlignedBox3f box;
  for (const Piece* piece = begin; piece < end; ++piece) box.extend(piece->place);
  Eigen::Index longest = 0;
  box.sizes().maxCoeff(&longest);
  std::ptrdiff_t first_part = 1;
  while (2 * first_part < end - begin) first_part *= 2;
  Piece* const middle = begin + first_part;
  std::nth_element(begin, middle, end, [longest](const Piece& a, const Piece& b) {
    return a.place[longest] < b.place[longest];
  });
  order(begin, middle, together);
  order(middle, end, together);
}

constexpr std::uint32_t kNone = ~0U;

Eigen::Vector3f position(const std::vector<float>& vertices, std::size_t i) {
  return Eigen::Map<const Eigen::Vector3f>(&vertices[3 * i]);
}

/// Whether vertices that follow each other in the sender's order are neighbours in space: the mean
/// distance of such vertices in a sample is at most kFar times the mean length of an edge.
bool is_coherent(const std::vector<FaceIndices>& faces, const std::vector<float>& vertices) {
  constexpr std::size_t kMostSamples = 4096;
  constexpr double kFar = 4.0;
  const std::size_t count = vertices.size() / 3, samples = std::min(count, kMostSamples);
  double steps = 0.0, edges = 0.0;
  for (std::size_t i = 0; i < samples; ++i) {
    const std::size_t place = i * count / samples;
    const FaceIndices& face = faces[i * faces.size() / samples];
    const std::size_t next = std::min(place + 1, count - 1);
    steps += (position(vertices, next) - position(vertices, place)).norm();
    edges += (position(vertices, face[1]) - position(vertices, face[0])).norm();
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

/// Orders the pieces so that pieces that follow each other lie near each other: each aligned group
/// of 2^k pieces is compact. The place of a piece is that of its first vertex. Within a block, the
/// order is arbitrary.
///
/// As in a k-d tree, the places are divided in two across the longest side of the box around them,
/// and each part is divided again. The size of the first part is a power of 2, and not half of the
/// places, so that each part except the last consists of whole groups. Source: Bentley 1975. A
/// curve through a grid, such as Morton's, would be found in a third to half of the time, but its
/// parts are not compact: queries would take up to seven times as long.
void FaceClusters::order_pieces(const std::vector<float>& vertices) {
  const auto last = static_cast<std::uint32_t>(vertices.size() / 3 - 1);
  const std::uint32_t size = piece_size_;
  block_of_piece_.resize(last / size + 1);
  std::vector<Piece> pieces;
  pieces.reserve(block_of_piece_.size());
  for (std::uint32_t i = 0; i <= last; i += size) pieces.push_back({position(vertices, i), i});
  order(pieces.data(), pieces.data() + pieces.size(), kBlock / size);
  order_.reserve(vertices.size() / 3 + kBlock);
  for (const Piece& piece : pieces) {
    const std::uint32_t first = piece.first_vertex;
    block_of_piece_[first / size] = static_cast<std::uint32_t>(order_.size() / kBlock);
    for (std::uint32_t i = 0; i < size; ++i) order_.push_back(std::min(first + i, last));
  }
  order_.resize((order_.size() + kBlock - 1) / kBlock * kBlock, order_.back());
}

/// Sorts the faces by their cluster: the first block that holds one of their vertices. This
/// counting sort keeps the faces of a cluster in the order of their numbers.
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

/// Loads the coordinates of a vertex as one vector. load() also reads one coordinate of the next
/// vertex, so the last vertex of the mesh needs load_last().
Array4f load(const float* xyz) { return Eigen::Map<const Array4f>(xyz); }
Array4f load_last(const float* xyz) { return {xyz[0], xyz[1], xyz[2], 0.0F}; }

/// The box around the first `count` vertices. Adds the coordinates of these vertices to `sum`.
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

/// Fits the boxes of blocks of consecutive vertices. Iterates over the vertices in the sender's
/// order, because the boxes fit into the cache and the vertices may not. `block_of`: for each
/// piece, the number of its block. Returns the sum of all coordinates.
float fit_blocks(const std::vector<float>& vertices, const std::vector<std::uint32_t>& block_of,
                 std::vector<Box>& blocks) {
  // Prefetches, because the processor's own prefetching stops at the end of a memory page.
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

/// Fits the boxes of blocks of arbitrary vertices. `block_of`: for each vertex, the number of its
/// block. Returns the sum of all coordinates.
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

/// The box around the boxes of the kGroup members of a group.
Box join_members(const std::vector<Box>& members, std::size_t group) {
  Box box = members[group * kGroup];
  for (std::size_t i = 1; i < kGroup; ++i) box = box.join(members[group * kGroup + i]);
  return box;
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
  // If the sum is finite, all coordinates are finite. Otherwise the sum may only have overflowed.
  return std::isfinite(sum) ||
         std::all_of(vertices.begin(), vertices.end(), [](float x) { return std::isfinite(x); });
}

void BlockBoxes::fit_groups(const FaceClusters& clusters) {
  groups_.resize(std::max(groups_.size(), clusters.level_count()));
  for (std::size_t level = 0; level < clusters.level_count(); ++level) {
    const std::vector<Box>& members = level == 0 ? blocks_ : groups_[level - 1];
    groups_[level].assign(padded(clusters.group_count(level)), empty_box());
    for (std::size_t group = 0; group < clusters.group_count(level); ++group) {
      Box box = join_members(members, group);
      if (level == 0) {
        for (const std::uint32_t block : clusters.border(group)) box = box.join(blocks_[block]);
      }
      groups_[level][group] = box;
    }
  }
}

}  // namespace organ_collision
