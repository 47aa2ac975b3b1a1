#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/distance/surface_touch.hpp"
#include "organ_collision/query/contact.hpp"
#include "picking/pickers/picker.hpp"
#include "step.hpp"

namespace organ_collision {

/// Confirms candidate faces by exact distances, leg by leg. A face touches a link once: on the
/// first leg on which any part of the link comes within its radius. Keeps its memory between steps.
class ContactConfirmer {
 public:
  /// Begins with another step.
  void start(const Step& step);

  /// Adds the contacts of a part with its candidates on the legs of a span. All parts and spans of
  /// a link follow one another.
  void confirm(const Step& step, const LegSpan& span, const ToolPart& part,
               const std::vector<Candidate>& candidates, std::vector<FaceContact>& contacts);

 private:
  /// A candidate face that the part may touch on some leg, but not before `leg`.
  struct PendingFace {
    std::uint32_t face;
    std::size_t leg;
    /// Unit, from the part to the face where they come near each other. Zero: not known.
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  };

  void keep_faces_near_chord(const Step& step, const LegSpan& span, const ToolPart& part);
  void confirm_on_leg(const Step& step, std::size_t leg, const ToolPart& part,
                      std::vector<FaceContact>& contacts);
  void find_touches(const PartLeg& part, const LinkPart* shape, double radius);
  bool is_pending(std::uint32_t face, std::size_t leg) const;
  void forget_touched_faces();

  WorkBudget budget_;  ///< of the present step
  std::vector<PendingFace> pending_faces_;
  std::vector<FaceTouch> touches_;
  SurfaceTouches surface_touches_;
  std::uint32_t link_ = 0;  ///< the number of the present link
  /// For each face, the leg on which the present link first touched it, counted from 1. Zero: it
  /// has not touched the face so far.
  std::vector<std::uint32_t> touched_leg_;
  std::vector<std::uint32_t> touched_faces_;  ///< for which touched_leg_ is not zero
};

}  // namespace organ_collision
