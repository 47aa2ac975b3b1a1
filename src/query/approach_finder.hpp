#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/distance/closest_approach.hpp"
#include "geometry/distance/face_search.hpp"
#include "step.hpp"
#include "tool_part.hpp"

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

}  // namespace organ_collision
