#include "springs.hpp"

#include <organ_collision/ContactArray.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "ros/messages/conversions.hpp"
#include "ros/messages/failure_log.hpp"

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

/// [1] The search ends when the uncovered part of each depth is at most this share of the greatest
/// depth.
constexpr double kTolerance = 1e-6;
// Limits of the search. Ordinary contacts need one to three springs.
constexpr int kRounds = 8;
constexpr int kSpringsARound = 16;
constexpr int kSweeps = 200;

struct Spring {
  Vector3d normal;
  double depth;         ///< [m] d_i of penalty_forces()
  double length = 0.0;  ///< [m] l_i of penalty_forces()
  double lack = 0.0;    ///< [m] the part of the depth that the springs do not cover
};

double agreement(const Vector3d& a, const Vector3d& b) { return std::max(0.0, a.dot(b)); }

/// Repeatedly lengthens the spring with the greatest lack. Stops when no lack exceeds `tolerance`
/// [m], or after kSpringsARound times. Adds the lengthened springs to `used`. Returns whether it
/// lengthened any.
bool lengthen(std::vector<Spring>& springs, std::vector<std::size_t>& used, double tolerance) {
  for (int count = 0; count < kSpringsARound; ++count) {
    const auto most =
        std::max_element(springs.begin(), springs.end(),
                         [](const Spring& a, const Spring& b) { return a.lack < b.lack; });
    if (most->lack <= tolerance) return count > 0;
    const std::size_t i = most - springs.begin();
    if (std::find(used.begin(), used.end(), i) == used.end()) used.push_back(i);
    const double by = most->lack;
    const Vector3d along = most->normal;
    most->length += by;
    for (Spring& spring : springs) spring.lack -= by * agreement(spring.normal, along);
  }
  return true;
}

/// Changes the lengths of the springs `used` by projected Gauss-Seidel sweeps. The new length is
/// the part of the spring's depth that the other springs do not cover. Ends when all changes in a
/// sweep are less than `tolerance` [m], or after kSweeps sweeps.
void balance(std::vector<Spring>& springs, const std::vector<std::size_t>& used, double tolerance) {
  double change = tolerance;
  for (int sweep = 0; sweep < kSweeps && change >= tolerance; ++sweep) {
    change = 0.0;
    for (const std::size_t i : used) {
      double others = 0.0;
      for (const std::size_t j : used) {
        if (j != i) others += springs[j].length * agreement(springs[j].normal, springs[i].normal);
      }
      const double length = std::max(0.0, springs[i].depth - others);
      change = std::max(change, std::abs(length - springs[i].length));
      springs[i].length = length;
    }
  }
}

/// Sets the part of each depth that the springs do not cover.
void find_lacks(std::vector<Spring>& springs, const std::vector<std::size_t>& used) {
  for (Spring& spring : springs) {
    spring.lack = spring.depth;
    for (const std::size_t i : used) {
      spring.lack -= springs[i].length * agreement(springs[i].normal, spring.normal);
    }
  }
}

/// Finds the lengths of all springs. Returns the indices of the springs whose length can differ
/// from zero.
std::vector<std::size_t> find_lengths(std::vector<Spring>& springs) {
  double greatest = 0.0;
  for (const Spring& spring : springs) greatest = std::max(greatest, spring.depth);
  const double tolerance = kTolerance * greatest;
  std::vector<std::size_t> used;
  if (springs.empty()) return used;
  find_lacks(springs, used);
  for (int round = 0; round < kRounds && lengthen(springs, used, tolerance); ++round) {
    balance(springs, used, 0.1 * tolerance);
    find_lacks(springs, used);
  }
  return used;
}

/// How much of the spring's force acts at this push, up to a factor.
double weight_of(const Push& push, const Spring& spring) {
  return std::max(0.0, push.depth) * agreement(push.normal, spring.normal);
}

/// Adds the force of a spring to the forces of the pushes in its direction.
void share(const Spring& spring, const Vector3d& force, const std::vector<Push>& pushes,
           std::vector<Vector3d>& forces) {
  double weights = 0.0;
  for (const Push& push : pushes) weights += weight_of(push, spring);
  for (std::size_t j = 0; j < pushes.size(); ++j) {
    forces[j] += weight_of(pushes[j], spring) / weights * force;
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

std::vector<Vector3d> penalty_forces(const std::vector<Push>& pushes, double stiffness) {
  std::vector<Spring> springs;
  for (const Push& push : pushes) {
    if (push.counts && push.depth > 0.0) springs.push_back({push.normal, push.depth});
  }
  std::vector<Vector3d> forces(pushes.size(), Vector3d::Zero());
  for (const std::size_t i : find_lengths(springs)) {
    share(springs[i], -stiffness * springs[i].length * springs[i].normal, pushes, forces);
  }
  Vector3d sum = Vector3d::Zero(), torque = Vector3d::Zero();
  for (std::size_t j = 0; j < pushes.size(); ++j) {
    sum += forces[j];
    torque += pushes[j].place.cross(forces[j]);
  }
  if (!sum.allFinite() || !torque.allFinite()) {
    throw Rejection(ContactArray::INVALID_REQUEST, "force not finite",
                    "the force of " + std::to_string(springs.size()) + " contacts is not finite");
  }
  return forces;
}

}  // namespace organ_collision
