#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "contact_refiner.hpp"
#include "geometry/distance/surface_touch.hpp"
#include "organ_collision/query/contact.hpp"
#include "picking/pickers/picker.hpp"
#include "step.hpp"

namespace organ_collision {

/// Finds the contacts of a step. For each part of the tool and each span of legs, GL picks the
/// faces that may touch; then exact distances decide leg by leg. Keeps its memory between steps.
class ContactFinder {
 public:
  /// `picker` must outlive it.
  explicit ContactFinder(Picker& picker) : picker_(picker) {}

  /// Adds the contacts of all parts of the tool, in no particular order. If several parts of a link
  /// touch a face, there may be several contacts of the same face and link, and the first touch is
  /// among them. Throws GlError if GL did not work.
  void find(const Step& step, std::vector<FaceContact>& contacts);

 private:
  /// A candidate face that the part may touch on some leg, but not before `leg`.
  struct PendingFace {
    std::uint32_t face;
    std::size_t leg;
    /// Unit, from the part to the face where they come near each other. Zero: not known.
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  };

  void find_part_contacts(const Step& step, const LegSpan& span, const ToolPart& part,
                          std::vector<FaceContact>& contacts);
  void pick(const Step& step, const LegSpan& span, const ToolPart& part);
  void keep_faces_near_chord(const Step& step, const LegSpan& span, const ToolPart& part);
  void find_contacts_on_leg(const Step& step, std::size_t leg, const ToolPart& part,
                            std::vector<FaceContact>& contacts);
  void find_touches(const PartLeg& part, const LinkPart* shape, double radius);
  bool is_pending(std::uint32_t face, std::size_t leg) const;
  void forget_touched_legs(const std::vector<FaceContact>& touched, std::size_t begin);

  Picker& picker_;
  WorkBudget budget_;  ///< of the present step
  std::vector<Candidate> candidates_;
  std::vector<PendingFace> pending_faces_;
  std::vector<FaceTouch> touches_;
  SurfaceTouches surface_touches_;
  /// For each face, the leg on which the present link first touched it, counted from 1. Zero: it
  /// has not touched the face so far.
  std::vector<std::uint32_t> touched_leg_;
};

}  // namespace organ_collision
