#include "organ_report.hpp"

#include <ros/console.h>

#include <exception>
#include <iterator>

#include "geometry/concatenate.hpp"
#include "ros/messages/conversions.hpp"
#include "ros/messages/text.hpp"
#include "ros/node/queues.hpp"

namespace organ_collision {
namespace {

constexpr char kNotYetKnown[] = "not yet known";

Eigen::AlignedBox3d box_of(const DeformableOrgan& organ) {
  return organ.latest().mesh->box().cast<double>();
}

}  // namespace

std::string closedness(const OrganSurface& surface) {
  if (!surface.is_found()) return kNotYetKnown;
  if (surface.topology().is_closed()) return "closed";
  return "open (" + counted(surface.topology().open_edge_count(), "edge") + ")";
}

std::string orientation(const OrganSurface& surface) {
  if (!surface.is_found()) return kNotYetKnown;
  if (!surface.topology().is_closed()) return "none";
  return surface.is_inward() ? "inward" : "outward";
}

std::string summary(const DeformableOrgan& organ) {
  return concatenate("organ '", organ.name(),
                     "': ", counted(organ.latest().mesh->face_count(), "face"), ", ",
                     closedness(*organ.surface()), ", ", sides_of(box_of(organ)), " m");
}

std::vector<std::string> doubts(const DeformableOrgan& organ) {
  std::vector<std::string> sentences;
  const std::string size = doubt_about_organ(organ.name(), box_of(organ));
  if (!size.empty()) sentences.push_back(size);
  if (organ.surface()->is_found() && organ.surface()->is_inward()) {
    sentences.push_back("the faces of organ '" + organ.name() +
                        "' point inward, so that `behind` and the direction of crossings are "
                        "reversed: swap two vertices of each triangle");
  }
  return sentences;
}

namespace {

/// Called in the background thread. A surface that nobody needs any more is left out.
void find_surface(const std::weak_ptr<OrganSurface>& needed, const std::string& organ) {
  const std::shared_ptr<OrganSurface> surface = needed.lock();
  if (!surface) return;
  try {
    surface->find();
  } catch (const std::exception& error) {  // Usually std::bad_alloc.
    ROS_WARN("whether organ '%s' is closed could not be found out: %s", organ.c_str(),
             error.what());
  }
}

}  // namespace

void SurfaceInspector::update(const OrganRegistry& organs, Time now) {
  for (const auto& [name, organ] : organs.organs()) {
    Inspection& inspection = inspections_[name];
    if (inspection.surface != organ.surface()) start(organ, inspection);
    if (!inspection.told && inspection.surface->is_found()) tell(organ, inspection, now);
  }
  if (inspections_.size() > organs.organs().size()) forget_removed(organs);
}

void SurfaceInspector::start(const DeformableOrgan& organ, Inspection& inspection) {
  const std::weak_ptr<OrganSurface> surface = organ.surface();
  call_later(background_, [surface, name = organ.name()] { find_surface(surface, name); });
  inspection.surface = organ.surface();  // Last, because the call may run out of memory.
  inspection.told = false;
}

void SurfaceInspector::tell(const DeformableOrgan& organ, Inspection& inspection, Time now) {
  inspection.told = true;
  if (now >= inspection.next_summary) {
    inspection.next_summary = now + kLogPeriod;
    ROS_INFO("%s", summary(organ).c_str());
  } else {
    ROS_DEBUG("%s", summary(organ).c_str());
  }
  const std::vector<std::string> sentences = doubts(organ);
  if (sentences.empty() || now < inspection.next_doubts) return;
  inspection.next_doubts = now + kLogPeriod;
  for (const std::string& sentence : sentences) ROS_WARN("%s", sentence.c_str());
}

void SurfaceInspector::forget_removed(const OrganRegistry& organs) {
  for (auto known = inspections_.begin(); known != inspections_.end();) {
    const bool removed = organs.organs().count(known->first) == 0;
    known = removed ? inspections_.erase(known) : std::next(known);
  }
}

}  // namespace organ_collision
