#include "organ_report.hpp"

#include "geometry/concatenate.hpp"
#include "ros/interface/plain_text.hpp"
#include "ros/interface/plausible_size.hpp"

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

}  // namespace organ_collision
