#include "organ_report.hpp"

#include <ros/console.h>

#include "geometry/concatenate.hpp"
#include "ros/messages/conversions.hpp"
#include "ros/messages/text.hpp"

namespace organ_collision {
namespace {

constexpr char kNotYetKnown[] = "not yet known";

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

std::string summary(const std::string& organ, const OrganSurface& surface) {
  return concatenate("organ '", organ, "': ", counted(surface.face_count(), "face"), ", ",
                     closedness(surface), ", ", sides_of(surface.box()), " m");
}

std::vector<std::string> doubts(const std::string& organ, const Eigen::AlignedBox3d& box,
                                const OrganSurface& surface) {
  std::vector<std::string> sentences;
  const std::string size = doubt_about_organ(organ, box);
  if (!size.empty()) sentences.push_back(size);
  if (surface.is_found() && surface.is_inward()) {
    sentences.push_back("the faces of organ '" + organ +
                        "' point inward, so that `behind` and the direction of crossings are "
                        "reversed: swap two vertices of each triangle");
  }
  return sentences;
}

void SurfaceLog::tell(const std::string& organ, const OrganSurface& surface, Time now) {
  Next& next = next_[organ];
  if (now >= next.summary) {
    next.summary = now + kPeriod;
    ROS_INFO("%s", summary(organ, surface).c_str());
  }
  const std::vector<std::string> sentences = doubts(organ, surface.box(), surface);
  if (sentences.empty() || now < next.doubts) return;
  next.doubts = now + kPeriod;
  for (const std::string& sentence : sentences) ROS_WARN("%s", sentence.c_str());
}

}  // namespace organ_collision
