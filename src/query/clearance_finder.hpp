#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/distance/closest_approach.hpp"
#include "geometry/distance/face_search.hpp"
#include "organ_collision/query/clearance.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "organ_collision/query/contact.hpp"
#include "step.hpp"

namespace organ_collision {

/// The closest approach of a part of a tool and a face on one leg of a step.
struct PartApproach {
  double distance;  ///< [m] between the surfaces; see ToolClearance
  std::uint32_t face;
  ToolPart part;
  std::size_t leg;
  ClosestApproach approach;
};

/// Receives the approaches that ApproachFinder finds, and tells it which are of interest.
class ApproachSink {
 public:
  virtual ~ApproachSink() = default;
  /// [m] Greater distances are of no interest. May fall during a search.
  virtual double bound() const = 0;
  virtual bool accepts(std::uint32_t /*face*/) const { return true; }
  virtual void add(const PartApproach& approach) = 0;
  /// The work budget was used up before this face was measured. It may come nearer than its
  /// approaches tell, if there are any.
  virtual void add_unresolved(std::uint32_t /*face*/) {}
};

/// Finds how near the faces of an organ come to the parts of a tool during a step. The clusters'
/// boxes lead to the faces. Measuring a distance needs no clipping, so GL is not used. Keeps its
/// memory between steps.
class ApproachFinder {
 public:
  /// Adds to `sink` an approach for each part, leg and accepted face whose distance falls to the
  /// bound. A face may come nearer on another leg or to another part.
  void find(const Step& step, WorkBudget& budget, ApproachSink& sink);

 private:
  void find_near_chord(const Step& step, const LegSpan& span, const ToolPart& part,
                       WorkBudget& budget, ApproachSink& sink);
  void find_on_leg(const Step& step, std::size_t leg, const ToolPart& part, WorkBudget& budget,
                   ApproachSink& sink) const;

  FaceSearch search_;
  std::vector<std::uint32_t> faces_;  ///< that come within the bound of the present span's chord
};

/// Finds how far a tool is from an organ at the end of a step, and how near it came during the
/// step. Keeps its memory between steps.
class ClearanceFinder {
 public:
  /// The clearance that the request asks for. `contacts`: those of the step.
  ToolClearance find(const Step& step, const CollisionRequest& request,
                     const std::vector<FaceContact>& contacts,
                     WorkBudget budget = WorkBudget::for_approaches());

 private:
  std::optional<PartApproach> nearest(const Step& step, double distance_bound);
  void set_least(const Step& step, const CollisionRequest& request,
                 const std::vector<FaceContact>& contacts, ToolClearance& clearance);

  ApproachFinder approaches_;
  WorkBudget budget_;  ///< of the present step
};

/// Finds the faces within a margin of a tool that it does not touch during a step. Keeps its memory
/// between steps.
class NearFinder {
 public:
  /// Sets what `result` tells about near faces. The contacts in it are those of the step.
  void find(const Step& step, const CollisionRequest& request, CollisionResult& result,
            WorkBudget budget = WorkBudget::for_approaches());

 private:
  class Collector;

  ApproachFinder approaches_;
  std::vector<PartApproach> nearest_;  ///< one for each near face
  /// What is known of each face: kNothing, kTouched, kUnresolved, or its place in nearest_.
  std::vector<std::uint32_t> places_;
};

}  // namespace organ_collision
