#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "geometry/organ/seam_check.hpp"
#include "geometry/sides/face_crossing.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "organ_collision/query/placement.hpp"
#include "picking/pickers/picker.hpp"

namespace organ_collision {

/// Finds on which side of an organ's surface a tool is, and where its axis crosses the surface. GL
/// picks the faces near the axis, and exact predicates decide which of them the axis crosses. Keeps
/// its memory between queries. See doc/theory/geometry.md, Sides and crossings.
class PlacementFinder {
 public:
  /// `picker` must outlive this object.
  explicit PlacementFinder(Picker& picker) : picker_(picker) {}

  /// Fills `placement`, which must be empty, for the end of the step. Throws GlError if GL did not
  /// work.
  void find(const CollisionRequest& request, AxisPlacement& placement);

 private:
  /// The faces of an organ, with the vertices as which their corners count (SurfaceTopology).
  struct Surface {
    const TriangleMesh& organ;
    const SurfaceTopology* welding;  ///< null: corners count as themselves
    bool has_sides;

    Triangle face(std::uint32_t number) const {
      const FaceIndices& corners = organ.faces()[number];
      return organ.triangle(welding ? welding->welded(corners) : corners);
    }
  };
  struct FoundCrossing {
    std::uint32_t face;
    int direction;
    FaceCrossing place;
  };

  void find_axis(const Surface& surface, const ShaftAxis& axis, AxisPlacement& placement);
  void pick_near(const ShaftAxis& axis, const TriangleMesh& organ);
  void find_crossings(const Surface& surface, const ShaftAxis& axis,
                      std::vector<AxisCrossing>& crossings);
  int winding_number(const Surface& surface, const Eigen::Vector3d& point);
  bool is_on_candidate(const Surface& surface, const Eigen::Vector3d& point) const;

  Picker& picker_;
  SeamCheck seam_check_;
  std::vector<Candidate> candidates_;  ///< the faces near the axis that was picked last
  std::vector<FoundCrossing> found_;
};

}  // namespace organ_collision
