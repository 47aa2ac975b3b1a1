#include "compact_order.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace organ_collision {
namespace {

/// A piece with its place [m]. Both together are moved faster than the place is looked up.
struct Piece {
  Eigen::Vector3f place;
  std::uint32_t first_vertex;
};

/// The size of the first part: the largest power of 2 below a count above 1.
std::ptrdiff_t first_part(std::ptrdiff_t count) {
  std::ptrdiff_t size = 1;
  while (2 * size < count) size *= 2;
  return size;
}

void order(Piece* begin, Piece* end, std::ptrdiff_t together) {
  if (end - begin <= together) return;
  Eigen::AlignedBox3f box;
  for (const Piece* piece = begin; piece < end; ++piece) box.extend(piece->place);
  Eigen::Index longest = 0;
  box.sizes().maxCoeff(&longest);
  Piece* const middle = begin + first_part(end - begin);
  std::nth_element(begin, middle, end, [longest](const Piece& a, const Piece& b) {
    return a.place[longest] < b.place[longest];
  });
  order(begin, middle, together);
  order(middle, end, together);
}

}  // namespace

std::vector<std::uint32_t> compact_order(const std::vector<float>& vertices, std::size_t piece,
                                         std::size_t together) {
  std::vector<Piece> pieces;
  pieces.reserve(vertices.size() / 3 / piece + 1);
  for (std::size_t i = 0; 3 * i < vertices.size(); i += piece) {
    pieces.push_back(
        {Eigen::Map<const Eigen::Vector3f>(&vertices[3 * i]), static_cast<std::uint32_t>(i)});
  }
  order(pieces.data(), pieces.data() + pieces.size(), static_cast<std::ptrdiff_t>(together));
  std::vector<std::uint32_t> first_vertices;
  first_vertices.reserve(pieces.size());
  for (const Piece& ordered : pieces) first_vertices.push_back(ordered.first_vertex);
  return first_vertices;
}

}  // namespace organ_collision
