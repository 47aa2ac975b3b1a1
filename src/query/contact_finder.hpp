#pragma once

#include <vector>

#include "contact_confirmer.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "picking/pickers/picker.hpp"
#include "step.hpp"

namespace organ_collision {

/// Finds contacts by the method of Lombardo, Cani and Neyret 1999 ("the paper"). Keeps its memory
/// between steps.
class ContactFinder {
 public:
  /// `picker` must outlive it.
  explicit ContactFinder(Picker& picker) : picker_(picker) {}

  /// Adds the contacts of all parts of the tool: one for each face and link that touch, sorted by
  /// face, then link. Throws GlError if GL did not work.
  void find(const Step& step, std::vector<FaceContact>& contacts);

  /// Adds the faces in the paper's own volume for a request in one of its modes, with their depth
  /// ranges and nothing else.
  void find_in_paper_volume(const CollisionRequest& request, std::vector<FaceContact>& contacts);

 private:
  void find_part_contacts(const Step& step, const LegSpan& span, const ToolPart& part,
                          std::vector<FaceContact>& contacts);

  Picker& picker_;
  std::vector<Candidate> candidates_;
  ContactConfirmer confirmer_;
};

}  // namespace organ_collision
