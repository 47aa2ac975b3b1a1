#include <algorithm>
#include <cstdio>

#include "markers.hpp"
#include "ros/messages/text.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

// In this file, lengths are shares of the organ's size.
constexpr double kTextHeight = 0.03;
constexpr std::size_t kLongestReason = 100;  // [bytes]

std::string rounded(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

bool is_deeper(const Contact& a, const Contact& b) { return a.depth > b.depth; }

/// The place at `distance` from a contact, on the side of the tool.
Vector3d before(const Contact& contact, double distance) {
  return to_eigen(contact.end_point) - distance * to_eigen(contact.normal);
}

void add_regions(const SceneOrgan& organ, const ContactArray& answer, MarkerArray& picture) {
  constexpr double kWidth = 2e-3;
  Marker lines = make_marker({"regions", organ.frame, colours::kRegion}, Marker::LINE_LIST);
  lines.scale.x = kWidth * organ.size();
  const auto add = [&](const geometry_msgs::Point32& corner) {
    add_point(lines, {corner.x, corner.y, corner.z});
  };
  for (const geometry_msgs::Polygon& region : answer.regions) {
    for (std::size_t i = 0; i < region.points.size(); ++i) {
      add(region.points[i]);
      add(region.points[(i + 1) % region.points.size()]);
    }
  }
  add_marker(std::move(lines), picture);
}

void add_normals(const SceneOrgan& organ, const ContactArray& answer, double share,
                 MarkerArray& picture) {
  constexpr double kLength = 0.07;
  std::vector<Contact> deepest(std::min(kMostArrows, answer.contacts.size()));
  std::partial_sort_copy(answer.contacts.begin(), answer.contacts.end(), deepest.begin(),
                         deepest.end(), is_deeper);
  const MarkerStyle style{"normals", organ.frame, colours::faded(colours::kNormal, share)};
  for (const Contact& contact : deepest) {
    add_arrow(style, before(contact, kLength * organ.size()), before(contact, 0.0), {}, picture);
  }
}

void add_names(const SceneOrgan& organ, const ContactArray& answer, double share,
               MarkerArray& picture) {
  constexpr double kDistance = 0.15;  // The distance of a name from its contact.
  std::map<std::uint32_t, const Contact*> by_link;
  for (const Contact& contact : answer.contacts) {
    const Contact*& known = by_link[contact.link];
    if (!known || is_deeper(contact, *known)) known = &contact;
  }
  const MarkerStyle style{"names", organ.frame, colours::faded(colours::kText, share)};
  for (const auto& [link, contact] : by_link) {
    const std::string& name = answer.links.at(link);
    add_text(style, before(*contact, kDistance * organ.size()), kTextHeight * organ.size(),
             name.empty() ? answer.tool : name, picture);
  }
}

void add_near_faces(const SceneOrgan& organ, const ContactArray& answer, MarkerArray& picture) {
  /// The opacity of a near face at the margin, as a share of that of a face at the tool.
  constexpr double kFaintest = 0.15;
  Marker faces = make_marker({"near", organ.frame, colours::kNearFace}, Marker::TRIANGLE_LIST);
  for (std::size_t i = 0; i < std::min(answer.near.size(), kMostNearFaces); ++i) {
    const double nearness =
        std::clamp(1.0 + answer.near[i].depth / answer.clearance.margin, kFaintest, 1.0);
    add_lifted_face(organ, answer.near[i].face, colours::faded(colours::kNearFace, nearness),
                    faces);
  }
  add_marker(std::move(faces), picture);
}

/// The unit vector at right angles to `normal` that points up most.
Vector3d upward(const Vector3d& normal) {
  const Vector3d up = Vector3d::UnitZ() - normal.z() * normal;
  return up.norm() > 0.1 ? Vector3d(up.normalized()) : normal.unitOrthogonal();
}

void add_clearance(const SceneOrgan& organ, const Clearance& clearance, MarkerArray& picture) {
  constexpr double kLineWidth = 4e-3;
  // The text is beside the line and away from the organ, so that neither tool nor organ hides it.
  constexpr double kTextDistance = 0.10;  // The distance of the text from the line.
  constexpr double kTextLift = 0.06;      // The shift of the text away from the organ.
  if (clearance.state != Clearance::KNOWN) return;
  const Vector3d on_tool = to_eigen(clearance.on_tool), on_organ = to_eigen(clearance.on_organ);
  const MarkerStyle style{"clearance", organ.frame, colours::kClearance};
  add_line(style, on_tool, on_organ, kLineWidth * organ.size(), picture);
  const Vector3d normal = to_eigen(clearance.normal);
  const Vector3d shift = kTextDistance * upward(normal) - kTextLift * normal;
  add_text(style, 0.5 * (on_tool + on_organ) + organ.size() * shift, kTextHeight * organ.size(),
           (clearance.unresolved ? "at most " : "") + rounded("%.1f mm", 1e3 * clearance.distance),
           picture);
}

/// For example ", 3.2 mm away". Empty if the clearance was not asked for.
std::string distance_text(const Clearance& clearance) {
  if (clearance.state == Clearance::KNOWN) {
    return rounded(", %.1f mm away", 1e3 * clearance.distance);
  }
  if (clearance.state != Clearance::BEYOND_MARGIN) return "";
  return rounded(", more than %.1f mm away", 1e3 * clearance.margin);
}

/// For example ", tip inside, 32.1 mm of its axis inside". Empty if nothing is known to be inside,
/// or on the surface.
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

void add_contacts(const SceneOrgan& organ, const ContactArray& answer, double share,
                  MarkerArray& picture) {
  add_regions(organ, answer, picture);
  add_normals(organ, answer, share, picture);
  add_names(organ, answer, share, picture);
}

void add_surroundings(const SceneOrgan& organ, const ContactArray& answer, MarkerArray& picture) {
  add_near_faces(organ, answer, picture);
  add_clearance(organ, answer.clearance, picture);
}

void add_crossings(const SceneOrgan& organ, const ShaftAxis& axis, double radius,
                   const ToolPlacement& placement, MarkerArray& picture) {
  constexpr double kRadius = 2.5;  // The radius of a cone, as a multiple of the shaft's radius.
  constexpr double kLeastRadius = 0.02;  // The least radius, as a share of the organ's size.
  constexpr double kLength = 2.0;        // The length of a cone, as a multiple of its radius.
  // An arrow that is nearly all head is a cone. RViz warns of an arrow without a shaft.
  const ArrowShape shape{0.01, 2.0 / kLength, 0.999};
  const double length = kLength * std::max(kRadius * radius, kLeastRadius * organ.size());
  const Vector3d cone = length * (axis.tip - axis.trocar).normalized();
  for (std::size_t i = 0; i < std::min(placement.crossings.size(), kMostCrossings); ++i) {
    const bool enters = placement.crossings[i].direction > 0;
    const Vector3d point = to_eigen(placement.crossings[i].point);
    const Vector3d base = enters ? Vector3d(point - cone) : point;
    add_arrow({"crossings", organ.frame, enters ? colours::kEntering : colours::kLeaving}, base,
              base + cone, shape, picture);
  }
}

void add_status(const Scene& scene, const SceneOrgan& organ, double query_sec,
                MarkerArray& picture) {
  constexpr double kDistance = 0.15;  // The distance of the text from the organ's box.
  constexpr double kLineSpacing = 0.09;
  std::string text = organ.name + ": " + counted(organ.mesh->face_count(), "face");
  bool failed = false;
  for (const ScenePair& pair : scene.pairs) {
    if (pair.organ != organ.name) continue;
    text += "\n" + status_line((*scene.tools)[pair.tool].parameters.name, pair.answer);
    failed = failed || (pair.answer && pair.answer->status != ContactArray::OK);
  }
  if (query_sec > 0.0) text += rounded("\n%.0f us a query", 1e6 * query_sec);

  const Eigen::AlignedBox3d box = organ.mesh->box().cast<double>();
  const auto lines = 1 + std::count(text.begin(), text.end(), '\n');
  Vector3d place = box.center();  // The place of a text is its centre.
  place.z() = box.max().z() + (kDistance + 0.5 * kLineSpacing * lines) * organ.size();
  add_text({"status", organ.frame, failed ? colours::kFailure : colours::kText}, place,
           kTextHeight * organ.size(), text, picture);
}

std::string status_line(const std::string& tool, const ContactArrayConstPtr& answer) {
  if (!answer) return tool + ": no answer yet";
  if (answer->status != ContactArray::OK) {
    return tool + ": " + reason_of(answer->status) + ": " +
           plain_text(answer->message, kLongestReason);
  }
  const std::vector<Contact>& contacts = answer->contacts;
  if (contacts.empty()) {
    return tool + ": touches nothing" + distance_text(answer->clearance) +
           side_text(answer->placement);
  }
  // By is_deeper(), the deepest contact is the least one.
  const double depth = std::min_element(contacts.begin(), contacts.end(), is_deeper)->depth;
  return tool + ": " + counted(contacts.size(), "contact") +
         rounded(", %.1f mm deep", 1e3 * depth) + side_text(answer->placement);
}

}  // namespace organ_collision
