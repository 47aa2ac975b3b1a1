#include "penalty_wrench.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "ros/interface/conversions.hpp"
#include "ros/interface/rejection.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// [1] A shift that lacks at most this share of the greatest depth is enough.
constexpr double kEnough = 1e-6;
// Bounds of the search. Ordinary contacts need one to three springs.
constexpr int kRounds = 8;
constexpr int kSpringsARound = 16;
constexpr int kSweeps = 200;

struct Spring {
  Vector3d normal;
  double depth;         ///< [m] d in the law
  double length = 0.0;  ///< [m] l in the law
  double lack = 0.0;    ///< [m] what the lengths of all leave of the depth
};

double agreement(const Vector3d& a, const Vector3d& b) { return std::max(0.0, a.dot(b)); }

std::vector<Spring> springs_of(const std::vector<Push>& pushes) {
  std::vector<Spring> springs;
  for (const Push& push : pushes) {
    if (push.counts && push.depth > 0.0) springs.push_back({push.normal, push.depth});
  }
  return springs;
}

/// Lengthens the one that lacks most, again and again, until none lacks more than `enough`, some
/// times at most. Adds them to `used`. Returns whether there was any.
bool lengthen(std::vector<Spring>& springs, std::vector<std::size_t>& used, double enough) {
  for (int count = 0; count < kSpringsARound; ++count) {
    const auto most =
        std::max_element(springs.begin(), springs.end(),
                         [](const Spring& a, const Spring& b) { return a.lack < b.lack; });
    if (most->lack <= enough) return count > 0;
    const std::size_t i = most - springs.begin();
    if (std::find(used.begin(), used.end(), i) == used.end()) used.push_back(i);
    const double by = most->lack;
    const Vector3d along = most->normal;
    most->length += by;
    for (Spring& spring : springs) spring.lack -= by * agreement(spring.normal, along);
  }
  return true;
}

/// Balances the used springs by projected Gauss-Seidel sweeps: each is as long as the others leave
/// it to be.
void balance(std::vector<Spring>& springs, const std::vector<std::size_t>& used, double enough) {
  double change = enough;
  for (int sweep = 0; sweep < kSweeps && change >= enough; ++sweep) {
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

/// What the lengths leave of each depth.
void find_lacks(std::vector<Spring>& springs, const std::vector<std::size_t>& used) {
  for (Spring& spring : springs) {
    spring.lack = spring.depth;
    for (const std::size_t i : used) {
      spring.lack -= springs[i].length * agreement(springs[i].normal, spring.normal);
    }
  }
}

/// Finds all lengths; returns which of them may not be zero.
std::vector<std::size_t> find_lengths(std::vector<Spring>& springs) {
  double greatest = 0.0;
  for (const Spring& spring : springs) greatest = std::max(greatest, spring.depth);
  const double enough = kEnough * greatest;
  std::vector<std::size_t> used;
  if (springs.empty()) return used;
  find_lacks(springs, used);
  for (int round = 0; round < kRounds && lengthen(springs, used, enough); ++round) {
    balance(springs, used, 0.1 * enough);
    find_lacks(springs, used);
  }
  return used;
}

/// Where a spring acts: the mean place of all that push its way.
Vector3d place_of(const Spring& spring, const std::vector<Push>& pushes) {
  Vector3d sum = Vector3d::Zero();
  double weights = 0.0;
  for (const Push& push : pushes) {
    const double weight = std::max(0.0, push.depth) * agreement(push.normal, spring.normal);
    sum += weight * push.place;
    weights += weight;
  }
  return sum / weights;
}

}  // namespace

geometry_msgs::Wrench penalty_wrench(const std::vector<Push>& pushes, double stiffness) {
  std::vector<Spring> springs = springs_of(pushes);
  Vector3d force = Vector3d::Zero(), torque = Vector3d::Zero();
  for (const std::size_t i : find_lengths(springs)) {
    const Vector3d part = -stiffness * springs[i].length * springs[i].normal;
    force += part;
    torque += place_of(springs[i], pushes).cross(part);
  }
  if (!force.allFinite() || !torque.allFinite()) {
    throw Rejection(ContactArray::INVALID_REQUEST, "force not finite",
                    "the force of " + std::to_string(springs.size()) + " contacts is not finite");
  }
  geometry_msgs::Wrench wrench;
  wrench.force = to_vector(force);
  wrench.torque = to_vector(torque);
  return wrench;
}

}  // namespace organ_collision
