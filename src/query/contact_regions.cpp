#include "contact_regions.hpp"

#include <algorithm>
#include <tuple>

#include "picking/volumes/box_volume.hpp"
#include "picking/volumes/conservative_volume.hpp"

namespace organ_collision {

void ContactRegions::find(const Step& step, const std::vector<FaceContact>& contacts,
                          std::vector<Region>& regions) {
  regions.assign(contacts.size(), {});
  places_.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    places_.push_back({step.leg_at(contacts[i].fraction), contacts[i].link, i});
  }
  std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) {
    return std::tie(a.leg, a.link, a.contact) < std::tie(b.leg, b.link, b.contact);
  });
  for (Places begin = places_.begin(); begin != places_.end();) {
    const Places end = std::find_if_not(
        begin, places_.cend(), [&](const Place& place) { return place.shares_volumes(*begin); });
    clip(step, begin, end, contacts, regions);
    begin = end;
  }
}

/// Finds the regions of contacts that share leg and link.
void ContactRegions::clip(const Step& step, Places begin, Places end,
                          const std::vector<FaceContact>& contacts, std::vector<Region>& regions) {
  if (step.has_shaft() && begin->link == 0) {
    const ViewingVolume volume = tool_volume(step.shaft_motion(begin->leg), step.radius());
    return clip(volume, step.organ(), begin, end, contacts, regions);
  }
  const std::size_t link = begin->link - step.link_number(0);
  const RigidMotion motion = step.link_motion(begin->leg, link);
  for (const LinkPart& part : step.link(link).parts) {
    const SweptBox box(part.bounds, motion, part.radius);
    clip(tool_volume(box), step.organ(), begin, end, contacts, regions);
  }
}

/// Clips to a volume the faces of those contacts that have no region yet.
void ContactRegions::clip(const ViewingVolume& volume, const TriangleMesh& organ, Places begin,
                          Places end, const std::vector<FaceContact>& contacts,
                          std::vector<Region>& regions) {
  const auto for_each_missing = [&](auto visit) {
    for (Places place = begin; place != end; ++place) {
      if (regions[place->contact].empty()) visit(place->contact);
    }
  };
  faces_.clear();
  for_each_missing([&](std::size_t i) { faces_.push_back(contacts[i].face); });
  if (faces_.empty()) return;
  std::vector<Region> clipped = clipper_.clip(volume, organ, faces_);
  auto next = clipped.begin();
  for_each_missing([&](std::size_t i) { regions[i].swap(*next++); });
}

}  // namespace organ_collision
