#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "organ_collision/query/contact.hpp"
#include "picking/pickers/region_clipper.hpp"
#include "step.hpp"

namespace organ_collision {

/// Finds the regions of contacts. A region is the polygon in which the contact's face, as it is at
/// the end of the step, meets the tool's volume on the leg that touched it. The volume is the
/// shaft's, or that of the first part of the link whose volume the face meets. Keeps its memory
/// between steps.
class ContactRegions {
 public:
  /// `context` is what it draws in; it must outlive this object.
  explicit ContactRegions(GlContext& context) : clipper_(context) {}

  /// Replaces `regions` by one for each of `contacts`. Throws GlError if GL did not work.
  void find(const Step& step, const std::vector<FaceContact>& contacts,
            std::vector<Region>& regions);

 private:
  /// A contact and what decides about the volumes that its face is clipped to.
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
