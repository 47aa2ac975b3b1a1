#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

namespace organ_collision {

/// A contact of a jaw, of which only these fields decide what the jaws grasp.
struct JawContact {
  Eigen::Vector3d on_organ;  ///< [m]
  Eigen::Vector3d normal;    ///< unit vector from the jaw into the tissue
};

/// Contacts of two jaws that press on tissue from opposite sides.
struct OpposingPair {
  std::size_t first = 0, second = 0;  ///< the indices of the contacts
  double distance = 0.0;              ///< [m] from one to the other
};

/// How far, at most, each normal of an opposing pair is turned from the line between the contacts.
/// Jaws begin to grasp within the smaller angle and cease beyond the larger one, so that bumps of
/// the surface do not make a grasp begin and end again and again.
inline constexpr double kGraspAngleDeg = 45.0, kReleaseAngleDeg = 55.0;

/// [m] Contacts that are nearer than this have no line between them. They oppose if their normals
/// do.
inline constexpr double kSamePlace = 1e-6;

/// The opposing pair with the least distance; of several, the one with the least `first`, then the
/// least `second`. None: the jaws grasp nothing (msg/Grasp.msg has the definition). `grasped`:
/// whether the jaws grasp already, so that the larger angle counts. Where the contacts of the
/// second jaw lie apart, the time grows as n log n with the number of contacts.
std::optional<OpposingPair> grasped_pair(const std::vector<JawContact>& first,
                                         const std::vector<JawContact>& second, bool grasped);

}  // namespace organ_collision
