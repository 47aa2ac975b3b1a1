#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "moving_part.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "picking/pickers/picker.hpp"

namespace organ_collision {

/// Finds contacts by the method of Lombardo, Cani and Neyret 1999 ("the paper"). Keeps its memory
/// between steps.
class ContactFinder {
 public:
  /// `picker` must outlive this object.
  explicit ContactFinder(Picker& picker) : picker_(picker) {}

  /// Adds the contacts of the tool: one for each pair of a face and a link that touch, sorted by
  /// face, then link. Throws GlError if GL did not work.
  void find(const Step& step, std::vector<FaceContact>& contacts);

  /// For a request in one of the paper's modes, adds a contact for each face in the paper's volume,
  /// with its range of depths, and on request its region. Of a contact, only the number of the face
  /// is set.
  void find_in_paper_volume(const CollisionRequest& request, CollisionResult& result);

 private:
  /// A candidate face that the part may touch on the leg `leg` or later.
  struct PendingFace {
    std::uint32_t face;
    std::size_t leg;
    /// The unit vector from the part to the face at the time when they first come near each other.
    /// A plane at right angles to it separates both on most legs. Zero if it is not known.
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  };

  void find_part_contacts(const Step& step, const LegSpan& span, const ToolPart& part,
                          std::vector<FaceContact>& contacts);
  void confirm(const Step& step, const LegSpan& span, const ToolPart& part,
               const MovingPart& on_chord, std::vector<FaceContact>& contacts);
  void keep_faces_near_chord(const Step& step, const LegSpan& span, const MovingPart& on_chord);
  void confirm_on_leg(const Step& step, std::size_t leg, const MovingPart& on_leg,
                      std::vector<FaceContact>& contacts);
  void set_touching(const Step& step, std::vector<FaceContact>& contacts);
  bool is_pending(std::uint32_t face, std::size_t leg) const;
  void forget_touched_faces();

  Picker& picker_;
  WorkBudget budget_;  ///< the work of the present step
  std::vector<Candidate> candidates_;
  std::vector<PendingFace> pending_faces_;
  std::vector<FaceTouch> touches_;
  SurfaceTouches surface_touches_;
  std::int32_t link_ = kShaft;  ///< the number of the present link
  /// For each face, the leg on which the present link first touched it, counted from 1. Zero: the
  /// link has not touched the face so far.
  std::vector<std::uint32_t> touched_leg_;
  std::vector<std::uint32_t> touched_faces_;  ///< faces whose touched_leg_ is not zero
};

}  // namespace organ_collision
