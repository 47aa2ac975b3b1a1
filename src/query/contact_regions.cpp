#include "contact_regions.hpp"

#include <algorithm>
#include <tuple>

#include "picking/volumes/box_volume.hpp"
#include "picking/volumes/clipped_face.hpp"
#include "picking/volumes/conservative_volume.hpp"

namespace organ_collision {
namespace {

Region region_of(const TriangleMesh& organ, const FaceContact& contact,
                 const ViewingVolume& volume) {
  Region region = clipped(shifted(organ.triangle(contact.face), volume.origin()), volume);
  for (Eigen::Vector3d& corner : region) corner += volume.origin();
  return region;
}

}  // namespace

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
    for (Places place = begin; place != end; ++place) {
      regions[place->contact] = region_of(step.organ(), contacts[place->contact], volume);
    }
    return;
  }
  const std::size_t link = begin->link - step.link_number(0);
  const RigidMotion motion = step.link_motion(begin->leg, link);
  for (const LinkPart& part : step.link(link).parts) {
    const SweptBox box(part.bounds, motion, part.radius);
    const ViewingVolume volume = tool_volume(box);
    for (Places place = begin; place != end; ++place) {
      Region& region = regions[place->contact];
      if (region.empty()) region = region_of(step.organ(), contacts[place->contact], volume);
    }
  }
}

}  // namespace organ_collision
