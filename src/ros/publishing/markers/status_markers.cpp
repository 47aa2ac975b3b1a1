#include "status_markers.hpp"

#include <algorithm>
#include <cstdio>

#include "colours.hpp"
#include "ros/interface/plain_text.hpp"
#include "ros/interface/rejection.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using visualization_msgs::Marker;

constexpr std::size_t kLongestReason = 100;  // [bytes]
/// Shares of the organ's size.
constexpr double kHeight = 0.03;
constexpr double kDistance = 0.15;  ///< of the text from the organ's box
constexpr double kLineSpacing = 0.09;

std::string rounded(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

double deepest(const ContactArray& answer) {
  double deepest = answer.contacts.front().depth;
  for (const Contact& contact : answer.contacts) deepest = std::max(deepest, contact.depth);
  return deepest;
}

/// ", 3.2 mm away"; empty if nothing is known.
std::string distance_text(const Clearance& clearance) {
  if (clearance.state == Clearance::KNOWN) {
    return rounded(", %.1f mm away", 1e3 * clearance.distance);
  }
  if (clearance.state != Clearance::BEYOND_MARGIN) return "";
  return rounded(", more than %.1f mm away", 1e3 * clearance.margin);
}

/// ", tip inside, 32.1 mm of its axis inside"; empty if nothing is inside, or known to be.
std::string side_text(const ToolPlacement& placement) {
  std::string text;
  if (placement.tip == ToolPlacement::INSIDE) text += ", tip inside";
  if (placement.tip == ToolPlacement::ON_SURFACE) text += ", tip on the surface";
  if (placement.length_inside > 0.0) {
    text += rounded(", %.1f mm of its axis inside", 1e3 * placement.length_inside);
  }
  return text;
}

}  // namespace

std::string status_line(const std::string& tool, const ContactArrayConstPtr& answer) {
  if (!answer) return tool + ": no answer yet";
  if (answer->status != ContactArray::OK) {
    return tool + ": " + reason_of(answer->status) + ": " +
           plain_text(answer->message, kLongestReason);
  }
  const std::string contacts = answer->contacts.empty()
                                   ? "touches nothing" + distance_text(answer->clearance)
                                   : counted(answer->contacts.size(), "contact") +
                                         rounded(", %.1f mm deep", 1e3 * deepest(*answer));
  return tool + ": " + contacts + side_text(answer->placement);
}

void add_status(const Scene& scene, const SceneOrgan& organ, double query_sec, MarkerSheet& sheet) {
  std::string text = organ.name + ": " + counted(organ.faces->size(), "face");
  bool failed = false;
  for (const ScenePair& pair : scene.pairs) {
    if (pair.organ != organ.name) continue;
    text += "\n" + status_line((*scene.tools)[pair.tool].parameters.name, pair.answer);
    failed = failed || (pair.answer && pair.answer->status != ContactArray::OK);
  }
  if (query_sec > 0.0) text += rounded("\n%.0f us a query", 1e6 * query_sec);

  const Eigen::AlignedBox3d box = organ.box.cast<double>();
  Vector3d place = box.center();
  const auto lines = 1 + std::count(text.begin(), text.end(), '\n');
  // The place of a text is its centre.
  place.z() = box.max().z() + (kDistance + 0.5 * kLineSpacing * lines) * organ.size();
  Marker status = make_marker(marker_names::kStatus, organ.frame, Marker::TEXT_VIEW_FACING,
                              failed ? colours::failure() : colours::text());
  status.text = std::move(text);
  status.pose = pose_message(Eigen::Isometry3d(Eigen::Translation3d(place)));
  status.scale.z = kHeight * organ.size();
  sheet.add(std::move(status));
}

}  // namespace organ_collision
