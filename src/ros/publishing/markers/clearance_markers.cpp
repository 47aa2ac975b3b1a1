#include "clearance_markers.hpp"

#include <algorithm>
#include <cstdio>
#include <string>

#include "colours.hpp"
#include "lifted_face.hpp"
#include "ros/interface/conversions.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using visualization_msgs::Marker;

/// The opacity of a near face at the margin, as a share of that of a face at the tool.
constexpr double kFaintest = 0.15;
/// Shares of the organ's size.
constexpr double kLineWidth = 4e-3;
constexpr double kTextHeight = 0.03;
constexpr double kTextDistance = 0.10;  ///< from the line, at right angles to it
constexpr double kTextLift = 0.06;      ///< from the organ

std::string text_of(const Clearance& clearance) {
  char text[64];
  std::snprintf(text, sizeof text, "%s%.1f mm", clearance.unresolved ? "at most " : "",
                1e3 * clearance.distance);
  return text;
}

/// The unit vector at right angles to `normal` that points up most.
Vector3d upward(const Vector3d& normal) {
  const Vector3d up = Vector3d::UnitZ() - normal.z() * normal;
  return up.norm() > 0.1 ? Vector3d(up.normalized()) : normal.unitOrthogonal();
}

}  // namespace

void add_near_faces(const SceneOrgan& organ, const ContactArray& answer, MarkerSheet& sheet) {
  Marker faces =
      make_marker(marker_names::kNear, organ.frame, Marker::TRIANGLE_LIST, colours::near_face());
  const std::size_t count = std::min(answer.near.size(), kMostNearFaces);
  for (std::size_t i = 0; i < count; ++i) {
    const double nearness =
        std::clamp(1.0 + answer.near[i].depth / answer.clearance.margin, kFaintest, 1.0);
    add_lifted_face(organ, answer.near[i].face, colours::faded(colours::near_face(), nearness),
                    faces);
  }
  sheet.add(std::move(faces));
}

void add_clearance(const SceneOrgan& organ, const ContactArray& answer, MarkerSheet& sheet) {
  const Clearance& clearance = answer.clearance;
  if (clearance.state != Clearance::KNOWN) return;
  const Vector3d on_tool = to_eigen(clearance.on_tool), on_organ = to_eigen(clearance.on_organ);
  Marker line =
      make_marker(marker_names::kClearance, organ.frame, Marker::LINE_LIST, colours::clearance());
  line.scale.x = kLineWidth * organ.size();
  add_point(line, on_tool);
  add_point(line, on_organ);
  sheet.add(std::move(line));

  Marker text = make_marker(marker_names::kClearance, organ.frame, Marker::TEXT_VIEW_FACING,
                            colours::clearance());
  // Beside the line and away from the organ, so that neither tool nor organ hides it.
  const Vector3d normal = to_eigen(clearance.normal);
  const Vector3d shift = kTextDistance * upward(normal) - kTextLift * normal;
  const Vector3d place = 0.5 * (on_tool + on_organ) + organ.size() * shift;
  text.pose = pose_message(Eigen::Isometry3d(Eigen::Translation3d(place)));
  text.text = text_of(clearance);
  text.scale.z = kTextHeight * organ.size();
  sheet.add(std::move(text));
}

}  // namespace organ_collision
