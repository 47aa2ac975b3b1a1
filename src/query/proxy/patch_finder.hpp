#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "geometry/distance/face_search.hpp"
#include "organ_collision/query/contact.hpp"
#include "query/moving_part.hpp"

namespace organ_collision {

/// The place of a link, or of kShaft, in lists that have the shaft first and then each link.
inline std::size_t part_index(std::int32_t link) {
  return link == kShaft ? 0 : 1 + static_cast<std::size_t>(link);
}

/// Finds the nearest face of each locally convex patch of an organ near a tool at rest. FaceSearch
/// leads to the nearest faces. A nearer face covers a farther one if the plane between the tool and
/// the nearer face keeps the farther one as far from the tool, and both are near each other: a tool
/// that keeps away from the first keeps away from the second. If a still nearer face covers the
/// first one, the second may be nearer to the tool than the plane by up to a fifth of its distance.
/// Where tissue is known to come towards the tool, a face is also covered only if the same plane,
/// as far as the nearer face comes, keeps the farther one off as far as that one comes. Keeps its
/// memory between searches.
class PatchFinder {
 public:
  /// What is searched by a part of the tool [m].
  struct Limits {
    double distance;   ///< up to this distance between tool and face; 0: the part does not search
    double patch;      ///< a face covers others up to this distance from its nearest point, or up
                       ///< to its own distance from the tool if that is larger
    double clearance;  ///< at about this distance, patches must be smooth
  };

  /// How far tissue comes towards the tool beyond its shape.
  struct Coming {
    /// [m] How far each corner of a face comes against a unit vector: from 0 to `most`. The vector
    /// and the corners are in the organ's frame. Null: no tissue comes.
    std::function<Eigen::Vector3d(std::uint32_t face, const Triangle& corners,
                                  const Eigen::Vector3d& normal)>
        against = {};
    double most = 0.0;
  };

  /// A contact of a static query.
  struct Found {
    FaceContact contact;
    double distance;  ///< [m] between the surfaces; minus the radius where the core is pierced
    double advance;   ///< [m] by how much the face comes nearer to the tool
  };

  /// Adds the contacts of a static query that are not covered. The nearest face of each part of the
  /// tool is never covered. At most kMost faces a part are added, the nearest ones after tissue has
  /// come. Contacts of a part are sorted by this distance. `limits`: of the shaft, and of each
  /// link. `late` tells the advance of each contact, and `soon` which faces are covered. Each test
  /// of a face against a part takes one of `tests`, and so do some looks at how far faces come.
  /// Returns false if none was left before the end: nearer faces may be missing.
  bool find(const Step& step, const std::vector<Limits>& limits, const Coming& late,
            const Coming& soon, std::size_t& tests, std::vector<Found>& contacts);

 private:
  static constexpr std::size_t kMost = 64;

  /// The distance of the nearest face from the core of the tool's part [m], so far.
  struct Nearest {
    double now, ahead;  ///< ahead: after tissue has come
  };

  /// A face that was found. All lengths belong to the core of the tool's part [m].
  struct Patch {
    Patch(std::uint32_t its_face, const ClosestPoints& its_closest, const MovingPart& part,
          const Limits& limits);

    std::uint32_t face;
    ClosestPoints closest;
    /// From the core to the face. Zero if they meet: the face then covers no other one.
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    /// The support value of the core along the normal.
    double support = std::numeric_limits<double>::infinity();
    double ahead;      ///< the face's distance after tissue has come, or less
    double radius;     ///< it covers faces up to this distance from its nearest point
    double roughness;  ///< a covered face may be this much nearer than the plane

    /// Whether the plane at right angles to the normal keeps whatever is beyond `lowest` as far
    /// from the core as `distance`, or at least `nearest`.
    bool keeps_beyond(double lowest, double distance, double nearest) const;
    /// Whether it keeps a face off, whose corners are `corners`, now and after tissue has come.
    bool keeps_off(std::uint32_t number, const Triangle& corners, const Coming& coming,
                   const Nearest& nearest) const;
  };

  static double distance_ahead(const Patch& patch, const MovingPart& part, const Limits& limits,
                               const Triangle& corners, const Coming& coming);
  bool is_covered(std::uint32_t number, const Triangle& face, const Coming& coming,
                  const Nearest& nearest);
  bool is_covered(const BlockBoxes::Box& box, double most, const Nearest& nearest) const;

  FaceSearch search_;
  std::vector<Patch> patches_;  ///< of the present part
  std::vector<Patch> found_;    ///< the same, with some that nearer ones cover
  std::size_t last_ = 0;        ///< the patch that covered the last face: it often covers the next
};

}  // namespace organ_collision
