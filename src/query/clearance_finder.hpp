#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/distance/closest_approach.hpp"
#include "geometry/distance/face_search.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "step.hpp"

namespace organ_collision {

/// Finds how near an organ comes to a tool: the clearance and the near faces. FaceSearch leads to
/// the nearest faces. GL is not used, because measuring distances needs no clipping. Keeps its
/// memory between steps.
class ClearanceFinder {
 public:
  /// How far the tool is from the organ at the end of the step, and how near it came during the
  /// step, as the request asks. `contacts` are the contacts of the step.
  ToolClearance find(const Step& step, const CollisionRequest& request,
                     const std::vector<FaceContact>& contacts,
                     const WorkBudget& budget = WorkBudget::for_approaches());

  /// Sets the fields of `result` about near faces: faces within the margin that the tool does not
  /// touch during the step. `result` must hold the contacts of the step already.
  void find_near(const Step& step, const CollisionRequest& request, CollisionResult& result,
                 const WorkBudget& budget = WorkBudget::for_approaches());

 private:
  /// The closest approach of a part of the tool and a face on one leg of a step.
  struct Approach {
    double distance;  ///< [m] distance between the surfaces; see ToolClearance
    std::uint32_t face;
    ToolPart part;
    std::size_t leg;
    ClosestApproach closest;
  };

  std::optional<Approach> nearest(const Step& step, double distance_bound);
  void set_least(const Step& step, const CollisionRequest& request,
                 const std::vector<FaceContact>& contacts, ToolClearance& clearance);
  static double closing_speed(const Step& at_end, const CollisionRequest& request,
                              const Approach& end, const Eigen::Vector3d& normal);
  static FaceContact contact_of(const Step& step, const Approach& near);

  void find_approaches(const Step& step, double distance_bound);
  void find_near_chord(const Step& step, const LegSpan& span, const ToolPart& part);
  void find_on_leg(const Step& step, std::size_t leg, const ToolPart& part);
  std::optional<ClosestApproach> measure(const ToolPart& part, const PartLeg& leg,
                                         const OrganMotion& organ, std::uint32_t face,
                                         double distance_bound);
  bool is_searched(std::uint32_t face) const;
  void add(const Approach& approach);

  FaceSearch search_;
  WorkBudget budget_;                 ///< the work of the present search
  double bound_ = 0.0;                ///< [m] the greatest distance that is still of interest
  std::vector<std::uint32_t> faces_;  ///< faces within the bound of the present chord
  std::vector<Approach> found_;
  /// Whether an approach of each face is searched, or only the nearest approach of all faces.
  bool searches_each_face_ = false;
  /// If each face is searched: for each face its place in `found_`, or that it has none, that the
  /// tool touches it, or that it was not measured to the end.
  std::vector<std::uint32_t> places_;
};

}  // namespace organ_collision
