#include "organ_collision/geometry/organ/surface_topology.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace organ_collision {
namespace {

using Numbers = std::vector<std::uint32_t>;

/// The list in which each vertex counts as itself.
Numbers unwelded(std::size_t count) {
  Numbers numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0U);
  return numbers;
}

/// For each vertex that a face uses, the first used vertex at its place. Others count as
/// themselves.
Numbers weld(const std::vector<FaceIndices>& faces, const std::vector<float>& vertices) {
  struct Place {
    float x, y, z;
    std::uint32_t vertex;
  };
  Numbers welded = unwelded(vertices.size() / 3);
  std::vector<char> is_used(welded.size(), 0);
  for (const FaceIndices& face : faces) {
    for (const std::uint32_t corner : face) is_used[corner] = 1;
  }
  std::vector<Place> places;
  for (std::uint32_t i = 0; i < welded.size(); ++i) {
    if (is_used[i] == 0) continue;
    places.push_back({vertices[3 * i], vertices[3 * i + 1], vertices[3 * i + 2], i});
  }
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return std::tie(a.x, a.y, a.z, a.vertex) < std::tie(b.x, b.y, b.z, b.vertex);
  });
  const Place* first = places.data();
  for (const Place& place : places) {
    if (std::tie(place.x, place.y, place.z) != std::tie(first->x, first->y, first->z)) {
      first = &place;
    }
    welded[place.vertex] = first->vertex;
  }
  return welded;
}

/// An edge, in the list of its end with the lower number.
struct Edge {
  std::uint32_t higher;    ///< the end with the higher number
  std::int32_t direction;  ///< 1 if the edge leads to `higher`, -1 if it comes from there
};

/// Calls visit(lower, edge) for the three edges of each face. `lower` is the end with the lower
/// number. An edge from a vertex to itself is its own opposite, and is left out.
template <typename Visit>
void for_each_edge(const std::vector<FaceIndices>& faces, const Numbers& welded,
                   const Visit& visit) {
  for (const FaceIndices& face : faces) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = welded[face[i]], to = welded[face[(i + 1) % 3]];
      if (from < to) visit(from, Edge{to, 1});
      if (from > to) visit(to, Edge{from, -1});
    }
  }
}

/// The number of edges that do not occur equally often in both directions. The range is sorted by
/// `higher`, and all its edges have the same lower end.
std::size_t count_open(const Edge* edge, const Edge* end) {
  std::size_t open = 0;
  while (edge != end) {
    const std::uint32_t higher = edge->higher;
    std::int64_t surplus = 0;
    for (; edge != end && edge->higher == higher; ++edge) surplus += edge->direction;
    if (surplus != 0) ++open;
  }
  return open;
}

/// The number of open edges of all faces (count_open()). A counting sort by the lower ends brings
/// opposite edges together.
std::size_t count_open_edges(const std::vector<FaceIndices>& faces, const Numbers& welded) {
  std::vector<std::size_t> begin(welded.size() + 1, 0);
  for_each_edge(faces, welded, [&](std::uint32_t lower, Edge) { ++begin[lower + 1]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Edge> edges(begin.back());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for_each_edge(faces, welded,
                [&](std::uint32_t lower, Edge edge) { edges[next[lower]++] = edge; });
  std::size_t open = 0;
  for (std::size_t vertex = 0; vertex < welded.size(); ++vertex) {
    Edge* const first = edges.data() + begin[vertex];
    Edge* const last = edges.data() + begin[vertex + 1];
    std::sort(first, last, [](const Edge& a, const Edge& b) { return a.higher < b.higher; });
    open += count_open(first, last);
  }
  return open;
}

Eigen::Vector3d vertex(const std::vector<float>& vertices, std::size_t i) {
  return Eigen::Map<const Eigen::Vector3f>(&vertices[3 * i]).cast<double>();
}

}  // namespace

SurfaceTopology::SurfaceTopology(const std::vector<FaceIndices>& faces,
                                 const std::vector<float>& vertices)
    : welded_(unwelded(vertices.size() / 3)), open_edges_(count_open_edges(faces, welded_)) {
  if (open_edges_ > 0) {
    welded_ = weld(faces, vertices);
    open_edges_ = count_open_edges(faces, welded_);
  }
  auto seams = std::make_shared<std::vector<SeamVertex>>();
  for (std::uint32_t i = 0; i < welded_.size(); ++i) {
    if (welded_[i] != i) seams->push_back({i, welded_[i]});
  }
  seams_ = std::move(seams);
}

/// Sums the signed volumes of the tetrahedra between the faces and an apex. The apex is a vertex of
/// the surface: with the origin, rounding would be coarse if the organ is far from it.
double signed_volume(const SurfaceTopology& topology, const std::vector<FaceIndices>& faces,
                     const std::vector<float>& vertices) {
  if (faces.empty() || !topology.is_closed()) return 0.0;
  const Eigen::Vector3d apex = vertex(vertices, topology.welded()[faces.front()[0]]);
  double six_volumes = 0.0;
  for (const FaceIndices& face : faces) {
    const FaceIndices corners = topology.welded(face);
    const Eigen::Vector3d a = vertex(vertices, corners[0]) - apex;
    const Eigen::Vector3d b = vertex(vertices, corners[1]) - apex;
    const Eigen::Vector3d c = vertex(vertices, corners[2]) - apex;
    six_volumes += a.dot(b.cross(c));
  }
  return six_volumes / 6.0;
}

}  // namespace organ_collision
