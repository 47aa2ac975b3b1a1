#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/distance/face_search.hpp"
#include "moving_part.hpp"
#include "organ_collision/query/contact.hpp"

namespace organ_collision {

/// Finds the nearest faces of an organ in different directions from a tool at rest. The plane at
/// right angles to a face's contact normal covers all that is beyond it, as seen from the tool: who
/// keeps away from the face keeps away from what it covers. Each face up to some distance is found,
/// or covered by a face that is found, at kCovered of its distance. Keeps its memory between
/// searches.
class AroundFinder {
 public:
  /// [1] Where the plane of a face is, as a share of the distance between the face and the tool.
  static constexpr double kCovered = 0.8;

  /// Adds a contact of a static query for each face that is found: those of the shaft, then those
  /// of each link, sorted by the distance, which is minus their depth. Returns up to which distance
  /// [m] between tool and face the search is complete: `farthest`, or less where the organ is fine,
  /// but at least `nearest`. So the work is bounded. `nearest`: the organ's least distance.
  double find(const Step& step, double nearest, double farthest, std::vector<FaceContact>& faces);

 private:
  /// What is beyond it is covered: normal . x > offset [m], with a unit vector.
  struct Plane {
    Eigen::Vector3d normal;
    double offset;
  };

  /// `low`: gives the smallest normal . x of what may be covered.
  template <typename Low>
  bool is_covered(const Low& low);

  FaceSearch search_;
  std::vector<Plane> planes_;  ///< of the present link, or of the shaft
  std::size_t last_ = 0;       ///< the plane that covered last: it often covers the next
  std::size_t work_ = 0;       ///< what has been done: planes that were looked at
};

}  // namespace organ_collision
