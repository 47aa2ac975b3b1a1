#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/distance/face_search.hpp"
#include "nearest_faces.hpp"
#include "organ_collision/query/collision_query.hpp"

namespace organ_collision {

/// The nearest face within the margin at the end of a step.
struct NearestAtEnd {
  bool is_known = false;
  std::optional<Approach> nearest;  ///< none: all faces are beyond the margin
};

/// Finds how near an organ comes to a tool: the clearance and the near faces. FaceSearch leads to
/// the nearest faces. GL is not used, because measuring distances needs no clipping. Keeps its
/// memory between steps.
class ClearanceFinder {
 public:
  /// How far the tool is from the organ at the end of the step, and how near it came during the
  /// step, as the request asks. `contacts` are the contacts of the step. `end`: what find_near()
  /// returned for this step, so that it need not be searched again.
  ToolClearance find(const Step& step, const CollisionRequest& request,
                     const std::vector<FaceContact>& contacts, const NearestAtEnd& end = {},
                     const WorkBudget& budget = WorkBudget::for_clearance());

  /// Sets the fields of `result` about near faces: faces within the margin that the tool does not
  /// touch during the step. `result` must hold the contacts of the step already. The end of a step
  /// without motion and contacts is then known.
  NearestAtEnd find_near(const Step& step, const CollisionRequest& request, CollisionResult& result,
                         std::optional<WorkBudget> budget = {});

 private:
  class LegSearch;

  std::optional<Approach> nearest(const Step& step, double distance_bound);
  void set_least(const Step& step, const CollisionRequest& request,
                 const std::vector<FaceContact>& contacts, ToolClearance& clearance);
  void find_approaches(const Step& step);
  void search_leg(const Step& step, std::size_t leg, const ToolPart& part);
  bool list_faces_near_chord(const Step& step, const LegSpan& span, const ToolPart& part);
  void measure_listed_faces(const Step& step, std::size_t leg, const ToolPart& part);

  FaceSearch search_;
  WorkBudget budget_;  ///< the work of the present search
  NearestFaces nearest_;
  std::size_t unmeasured_ = 0;         ///< see CollisionResult::near_unresolved
  std::vector<std::uint32_t> listed_;  ///< faces near the chord of the present span
  /// The separation [m] of the present part and the nearest face so far, on any leg of the present
  /// span. The plane at right angles to it excludes most of the other faces.
  Eigen::Vector3d separation_;
};

}  // namespace organ_collision
