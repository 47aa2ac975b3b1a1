#pragma once

#include <organ_collision/ContactArray.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "kept_sides.hpp"

namespace organ_collision {

/// Pushes a tool that is wholly inside a closed organ along the nearest way out.
///
/// Such a tool touches no face. Its side of the surface is known from ContactArray.placement, the
/// way out from ContactArray.clearance: its normal points to the nearest face. The depth is the
/// distance by which the tool must move along the normal to leave the organ: the clearance's
/// distance plus the depth inside, which is twice the radius for a shaft. For a link it is the
/// depth with which the link was last pushed before it lost touch, or 0 if it was never seen to
/// enter. So the depth continues where the contacts end.
///
/// A tool is taken to be inside if the clearance was asked for, its tip is inside and, for a tool
/// with a shaft, its trocar is inside too and no face is crossed. A tool with links must also touch
/// nothing, because a link may be half inside. The links of a tool are taken to be on the same side
/// as its tip then.
class WayOut {
 public:
  /// `enabled`: false if tools inside shall not be pushed out, for example in a hollow organ.
  explicit WayOut(bool enabled = true) : enabled_(enabled) {}

  /// One push for each contact, in the order of the contacts. If the tool is inside and no contact
  /// pushes it, also the push along the nearest way out: its place is the clearance's `on_organ`.
  /// `answer`, `shaft_radius`: as for KeptSides::follow().
  ///
  /// Throws Rejection if the tool is inside and nothing pushes it, but the clearance does not tell
  /// the way out: no face is within the margin, the distance is not resolved, or the normal is not
  /// defined.
  std::vector<Push> follow(const ContactArray& answer, const KeptSides::Radius& shaft_radius);

 private:
  KeptSides::DepthsInside depths_inside(const ContactArray& answer,
                                        const KeptSides::Radius& shaft_radius) const;
  void keep_depths(const ContactArray& answer, const std::vector<Push>& pushes);
  Push push_out(const ContactArray& answer, const KeptSides::Radius& shaft_radius) const;

  bool enabled_;
  KeptSides sides_;
  KeptSides::DepthsInside depths_;  ///< of the links, when they were last touched
  std::optional<bool> was_inside_;  ///< at the end of the last step; unset: nothing is known of it
  std::uint32_t topology_ = 0;
};

}  // namespace organ_collision
