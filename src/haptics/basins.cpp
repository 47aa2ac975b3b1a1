#include "basins.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "common/messages/conversions.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// [1] A barycentric coordinate up to this counts as zero: the point does not depend on the corner.
constexpr double kOnEdge = 1e-9;
/// [m] Smaller differences between the distances of two faces count as rounding errors.
constexpr double kNearer = 1e-9;

/// A vertex or an edge of a contact's face: two of its vertices in rising order, which are equal
/// for a vertex.
struct Corner {
  std::int32_t link;
  std::uint32_t low, high;
  std::size_t contact;  ///< the contact's index
  bool has_point;       ///< the contact's point is on it, and depends on no other vertex

  bool is_same(const Corner& other) const {
    return link == other.link && low == other.low && high == other.high;
  }
};

/// The vertices and edges of all contacts' faces. If faces that one link touches share a vertex or
/// an edge, its entries follow each other.
std::vector<Corner> corners_of(const std::vector<Contact>& contacts) {
  std::vector<Corner> corners;
  corners.reserve(6 * contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    const auto is_used = [&](std::size_t k) { return contact.barycentric[k] > kOnEdge; };
    const int used = is_used(0) + is_used(1) + is_used(2);
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = a; b < 3; ++b) {
        const auto [low, high] = std::minmax(contact.vertices[a], contact.vertices[b]);
        const bool has_point = is_used(a) && is_used(b) && used == (a == b ? 1 : 2);
        corners.push_back({contact.link, low, high, i, has_point});
      }
    }
  }
  std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
    return std::tie(a.link, a.low, a.high, a.contact) < std::tie(b.link, b.low, b.high, b.contact);
  });
  return corners;
}

/// Among faces that contain the point of contact i, the one that extends nearest to the tool, or i
/// itself if none is nearer.
template <typename Iterator>
std::size_t nearest_face(std::size_t i, const std::vector<Contact>& contacts, Iterator begin,
                         Iterator end) {
  const Vector3d point = to_eigen(contacts[i].point);
  const Vector3d normal = to_eigen(contacts[i].normal);
  std::size_t nearest = i;
  double most = kNearer;
  for (auto face = begin; face != end; ++face) {
    const double nearer = normal.dot(point - to_eigen(contacts[face->contact].point));
    if (nearer > most) {
      nearest = face->contact;
      most = nearer;
    }
  }
  return nearest;
}

/// Replaces each entry of `next` by the end of the path that starts there. A path that returns to
/// itself ends where the loop was entered. Loops can arise only from rounding, or among faces that
/// were first touched at different times.
void follow_to_the_end(std::vector<std::size_t>& next) {
  std::vector<std::size_t> passed_from(next.size(), next.size());
  for (std::size_t start = 0; start < next.size(); ++start) {
    std::size_t end = start;
    while (next[end] != end && passed_from[end] != start) {
      passed_from[end] = start;
      end = next[end];
    }
    next[end] = end;
    for (std::size_t i = start; i != end;) i = std::exchange(next[i], end);
  }
}

}  // namespace

std::vector<std::size_t> basins_of(const std::vector<Contact>& contacts) {
  std::vector<std::size_t> next(contacts.size());
  std::iota(next.begin(), next.end(), 0);
  const std::vector<Corner> corners = corners_of(contacts);
  for (auto begin = corners.begin(); begin != corners.end();) {
    const auto end = std::find_if(begin, corners.end(),
                                  [begin](const Corner& at) { return !at.is_same(*begin); });
    // Contacts whose points are on one corner have the same point, and so the same nearest face.
    std::optional<std::size_t> first, nearest;
    for (auto at = begin; at != end; ++at) {
      if (!at->has_point) continue;
      if (!nearest) {
        first = at->contact;
        nearest = nearest_face(*first, contacts, begin, end);
      }
      if (*nearest != *first) next[at->contact] = *nearest;
    }
    begin = end;
  }
  follow_to_the_end(next);
  return next;
}

}  // namespace organ_collision
