#include "springs.hpp"

#include <organ_collision/ContactArray.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "common/messages/failure_log.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

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
