#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "organ_collision/query/contact.hpp"
#include "picking/pickers/region_clipper.hpp"
#include "step.hpp"

namespace organ_collision {

/// Finds the regions of contacts. A region is the polygon in which the contact's face, as it is at
/// the end of the step, meets the tool's volume on the leg of the first touch. For a link, this is
/// the volume of its first part whose volume the face meets. Keeps its memory between steps.
class ContactRegions {
 public:
  /// Draws in `context`, which must outlive this object.
  explicit ContactRegions(GlContext& context) : clipper_(context) {}

  /// Replaces `regions` by one for each of `contacts`. Throws GlError if GL did not work.
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

  void clip(const Step& step, Places begin, Places end, const std::vector<FaceContact>& contacts,
            std::vector<Region>& regions);
  void clip(const ViewingVolume& volume, const TriangleMesh& organ, Places begin, Places end,
            const std::vector<FaceContact>& contacts, std::vector<Region>& regions);

  RegionClipper clipper_;
  std::vector<Place> places_;
  std::vector<std::uint32_t> faces_;
};

}  // namespace organ_collision
