#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "organ_collision/picking/region.hpp"
#include "organ_collision/query/contact.hpp"
#include "picking/volumes/viewing_volume.hpp"
#include "step.hpp"

namespace organ_collision {

/// Finds the regions of contacts. A region is the polygon in which the contact's face, as it is at
/// the end of the step, meets the tool's volume on the leg of the first touch. For a link, this is
/// the volume of its first part whose volume the face meets. Keeps its memory between steps.
class ContactRegions {
 public:
  /// Replaces `regions` by one for each of `contacts`.
  void find(const Step& step, const std::vector<FaceContact>& contacts,
            std::vector<Region>& regions);

 private:
  /// A contact, and the leg and link that determine to which volumes its face is clipped.
  struct Place {
    std::size_t leg;
    std::uint32_t link;
    std::size_t contact;

    bool shares_volumes(const Place& other) const { return leg == other.leg && link == other.link; }
  };
  using Places = std::vector<Place>::const_iterator;

  static void clip(const Step& step, Places begin, Places end,
                   const std::vector<FaceContact>& contacts, std::vector<Region>& regions);

  std::vector<Place> places_;
};

}  // namespace organ_collision
