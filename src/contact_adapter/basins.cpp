#include "basins.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "ros/messages/conversions.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// [1] A barycentric coordinate up to this counts as zero: the point does not depend on the corner.
constexpr double kOnEdge = 1e-9;
/// [m] Smaller differences between the distances of two faces count as rounding errors.
constexpr double kNearer = 1e-9;

/// The corners that the contact's point depends on: one, two (the point is on an edge), or three.
struct Support {
  std::array<std::uint32_t, 3> vertices{};  ///< for an edge: its two vertices in rising order
  std::size_t count = 0;
};

Support support_of(const Contact& contact) {
  Support support;
  for (std::size_t k = 0; k < 3; ++k) {
    if (contact.barycentric[k] > kOnEdge) support.vertices[support.count++] = contact.vertices[k];
  }
  if (support.count == 2 && support.vertices[0] > support.vertices[1]) {
    std::swap(support.vertices[0], support.vertices[1]);
  }
  return support;
}

bool holds(const Contact& face, const Support& support) {
  return std::all_of(support.vertices.begin(), support.vertices.begin() + support.count,
                     [&face](std::uint32_t vertex) {
                       return std::find(face.vertices.begin(), face.vertices.end(), vertex) !=
                              face.vertices.end();
                     });
}

/// Finds the contacts of a link whose faces have a given vertex.
class ContactsAtVertices {
 public:
  explicit ContactsAtVertices(const std::vector<Contact>& contacts) {
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      for (const std::uint32_t vertex : contacts[i].vertices) {
        at_[key(contacts[i].link, vertex)].push_back(i);
      }
    }
  }

  /// The contacts at that corner of the support that has the fewest contacts.
  const std::vector<std::size_t>& around(std::uint32_t link, const Support& support) const {
    const std::vector<std::size_t>* fewest = &at_.at(key(link, support.vertices[0]));
    if (support.count > 1) {
      const std::vector<std::size_t>& second = at_.at(key(link, support.vertices[1]));
      if (second.size() < fewest->size()) fewest = &second;
    }
    return *fewest;
  }

 private:
  static std::uint64_t key(std::uint32_t link, std::uint32_t vertex) {
    return (std::uint64_t{link} << 32U) | vertex;
  }

  std::unordered_map<std::uint64_t, std::vector<std::size_t>> at_;
};

/// The face that contains the point of contact i and extends nearest to the tool, or i itself if
/// none is nearer.
std::size_t nearer_face(std::size_t i, const Support& support, const std::vector<Contact>& contacts,
                        const std::vector<std::size_t>& around) {
  const Vector3d point = to_eigen(contacts[i].point);
  const Vector3d normal = to_eigen(contacts[i].normal);
  std::size_t nearest = i;
  double most = kNearer;
  for (const std::size_t j : around) {
    const double nearer = normal.dot(point - to_eigen(contacts[j].point));
    if (nearer > most && holds(contacts[j], support)) {
      nearest = j;
      most = nearer;
    }
  }
  return nearest;
}

/// Replaces each entry of `next` by the end of the path that starts there. A path that returns to
/// itself ends where the loop was entered. Loops can arise only from rounding, or among faces that
/// were first touched at different times.
void follow_to_the_end(std::vector<std::size_t>& next) {
  enum class Visit : std::uint8_t { kNone, kUnderWay, kDone };
  std::vector<Visit> visits(next.size(), Visit::kNone);
  std::vector<std::size_t> way;
  for (std::size_t start = 0; start < next.size(); ++start) {
    way.clear();
    std::size_t at = start;
    while (visits[at] == Visit::kNone && next[at] != at) {
      visits[at] = Visit::kUnderWay;
      way.push_back(at);
      at = next[at];
    }
    const std::size_t end = visits[at] == Visit::kDone ? next[at] : at;
    visits[end] = Visit::kDone;
    next[end] = end;
    for (const std::size_t i : way) {
      visits[i] = Visit::kDone;
      next[i] = end;
    }
  }
}

}  // namespace

std::vector<std::size_t> basins_of(const std::vector<Contact>& contacts) {
  const ContactsAtVertices at_vertices(contacts);
  // Contacts with the same support have the same point, and so the same nearer face. This face is
  // searched for only once. Otherwise each face around a vertex would be compared with each other
  // face.
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, std::size_t> seen;
  std::vector<std::size_t> next(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    next[i] = i;
    const Support support = support_of(contacts[i]);
    if (support.count == 0 || support.count == 3) continue;
    const auto [first, is_new] = seen.insert(
        {{contacts[i].link, support.vertices[0], support.vertices[support.count - 1]}, i});
    if (is_new) {
      next[i] = nearer_face(i, support, contacts, at_vertices.around(contacts[i].link, support));
    } else if (next[first->second] != first->second) {
      next[i] = next[first->second];
    }
  }
  follow_to_the_end(next);
  return next;
}

}  // namespace organ_collision
