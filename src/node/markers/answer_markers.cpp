#include <algorithm>
#include <cstdio>

#include "common/messages/conversions.hpp"
#include "common/messages/text.hpp"
#include "markers.hpp"

namespace organ_collision {

using Eigen::Vector3d;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

namespace {

using colours::rgba;

const std_msgs::ColorRGBA kRegion = rgba(0.05F, 0.05F, 0.05F);
const std_msgs::ColorRGBA kNormal = rgba(0.20F, 0.85F, 0.45F);
const std_msgs::ColorRGBA kNearFace = rgba(0.35F, 0.85F, 0.95F, 0.80F);
const std_msgs::ColorRGBA kClearance = rgba(0.35F, 0.95F, 1.00F);

// For each pair of organ and tool, only so many are drawn: the arrows of the deepest contacts, and
// the nearest faces.
constexpr std::size_t kMostArrows = 30;
constexpr std::size_t kMostNearFaces = 2000;

// In the functions below, lengths are shares of the organ's size.

std::string rounded(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

bool is_deeper(const Contact& a, const Contact& b) { return a.depth > b.depth; }

/// The place at `distance` [m] from a contact, on the side of the tool.
Vector3d before(const Contact& contact, double distance) {
  return to_eigen(contact.on_organ) - distance * to_eigen(contact.normal);
}

/// Adds the outlines of the regions.
void add_regions(const SceneOrgan& organ, const ContactArray& answer, MarkerArray& picture) {
  constexpr double kWidth = 2e-3;
  Marker lines = make_marker({"regions", organ.frame, kRegion}, Marker::LINE_LIST);
  lines.scale.x = kWidth * organ.size();
  for (const geometry_msgs::Polygon& region : answer.regions) {
    for (std::size_t i = 0; i < region.points.size(); ++i) {
      for (const std::size_t corner : {i, (i + 1) % region.points.size()}) {
        const geometry_msgs::Point32& point = region.points[corner];
        add_point(lines, {point.x, point.y, point.z});
      }
    }
  }
  add_marker(std::move(lines), picture);
}

/// Adds an arrow for each of the deepest contacts. The arrow points along the contact's normal and
/// ends at its end point.
void add_normals(const SceneOrgan& organ, const ContactArray& answer, MarkerArray& picture) {
  constexpr double kLength = 0.07;
  std::vector<Contact> deepest(std::min(kMostArrows, answer.contacts.size()));
  std::partial_sort_copy(answer.contacts.begin(), answer.contacts.end(), deepest.begin(),
                         deepest.end(), is_deeper);
  for (const Contact& contact : deepest) {
    add_arrow({"normals", organ.frame, kNormal}, before(contact, kLength * organ.size()),
              before(contact, 0.0), picture);
  }
}

/// Adds the name of each link that touches, at its deepest contact. A shaft has the name of its
/// tool. Each name is higher than the one before, so that none hides another.
void add_names(const SceneOrgan& organ, const ContactArray& answer, MarkerArray& picture) {
  constexpr double kDistance = 0.15;  // The distance of a name from its contact.
  constexpr double kRaise = 0.054;    // The height of a line of text.
  std::map<std::int32_t, const Contact*> by_link;
  for (const Contact& contact : answer.contacts) {
    const Contact*& known = by_link[contact.link];
    if (!known || is_deeper(contact, *known)) known = &contact;
  }
  double raise = 0.0;
  for (const auto& [link, contact] : by_link) {
    const Vector3d place = before(*contact, kDistance * organ.size()) + raise * Vector3d::UnitZ();
    const std::string& name =
        link == kShaft ? answer.tool : answer.links.at(static_cast<std::size_t>(link));
    add_text({"names", organ.frame, colours::kText}, place, organ.size(), name, picture);
    raise += kRaise * organ.size();
  }
}

/// Adds the near faces, at their present place: the nearer, the more opaque.
void add_near_faces(const SceneOrgan& organ, const ContactArray& answer, MarkerArray& picture) {
  /// The opacity of a near face at the margin, as a share of that of a face at the tool.
  constexpr double kFaintest = 0.15;
  Marker faces = make_marker({"near", organ.frame, kNearFace}, Marker::TRIANGLE_LIST);
  for (std::size_t i = 0; i < std::min(answer.near.size(), kMostNearFaces); ++i) {
    const double nearness = 1.0 + answer.near[i].depth / answer.clearance.margin;
    std_msgs::ColorRGBA colour = kNearFace;
    colour.a *= static_cast<float>(std::clamp(nearness, kFaintest, 1.0));
    add_lifted_face(faces, organ, answer.near[i].face, colour);
  }
  add_marker(std::move(faces), picture);
}

/// Adds a line between the nearest points of tool and organ. The status has its length.
void add_clearance(const SceneOrgan& organ, const Clearance& clearance, MarkerArray& picture) {
  constexpr double kLineWidth = 4e-3;
  if (clearance.state != Clearance::KNOWN) return;
  add_line({"clearance", organ.frame, kClearance}, to_eigen(clearance.on_tool),
           to_eigen(clearance.on_organ), kLineWidth * organ.size(), picture);
}

/// For example "probe: 3 contacts, 1.2 mm deep, tip inside, 32.1 mm of its axis inside", or "probe:
/// touches nothing, 3.2 mm away". If the step failed, for example "probe: no transform: ...", with
/// the message.
std::string status_line(const std::string& tool, const ContactArrayConstPtr& answer) {
  constexpr std::size_t kLongestReason = 100;  // [bytes]
  if (!answer) return tool + ": no answer yet";
  if (answer->status != ContactArray::OK) {
    return tool + ": " + reason_of(answer->status) + ": " +
           plain_text(answer->message, kLongestReason);
  }
  std::string line = tool + ": ";
  const Clearance& clearance = answer->clearance;
  if (const std::vector<Contact>& contacts = answer->contacts; !contacts.empty()) {
    // By is_deeper(), the deepest contact is the least one.
    const double depth = std::min_element(contacts.begin(), contacts.end(), is_deeper)->depth;
    line += counted(contacts.size(), "contact") + rounded(", %.1f mm deep", 1e3 * depth);
  } else {
    line += "touches nothing";
    if (clearance.state == Clearance::KNOWN) {
      line += clearance.unresolved ? ", at most" : ",";
      line += rounded(" %.1f mm away", 1e3 * clearance.distance);
    } else if (clearance.state == Clearance::BEYOND_MARGIN) {
      line += rounded(", more than %.1f mm away", 1e3 * clearance.margin);
    }
  }
  const ToolPlacement& placement = answer->placement;
  if (placement.tip == ToolPlacement::INSIDE) line += ", tip inside";
  if (placement.tip == ToolPlacement::ON_SURFACE) line += ", tip on the surface";
  if (placement.length_inside > 0.0) {
    line += rounded(", %.1f mm of its axis inside", 1e3 * placement.length_inside);
  }
  return line;
}

/// Whether the tool touches nothing of the organ, and is outside of it and beyond the margin.
bool is_far(const ScenePair& pair) {
  return pair.answer && pair.answer->status == ContactArray::OK && pair.answer->contacts.empty() &&
         pair.answer->clearance.state == Clearance::BEYOND_MARGIN &&
         pair.answer->placement.tip != ToolPlacement::INSIDE;
}

}  // namespace

void add_answer(const SceneOrgan& organ, const ContactArray& answer, MarkerArray& picture) {
  add_near_faces(organ, answer, picture);
  add_clearance(organ, answer.clearance, picture);
  add_regions(organ, answer, picture);
  add_normals(organ, answer, picture);
  add_names(organ, answer, picture);
}

void add_touched(const SceneOrgan& organ, double last_colour, MarkerArray& picture) {
  std::map<std::uint32_t, double> depths;  // The greatest one of each face.
  const auto note = [&](const ContactArray& answer) {
    for (const Contact& contact : answer.contacts) {
      double& depth = depths.emplace(contact.face, contact.depth).first->second;
      depth = std::max(depth, contact.depth);
    }
  };
  for (const ScenePair& pair : organ.pairs) {
    if (pair.answer) note(*pair.answer);
    for (const SceneStep& step : pair.steps) note(*step.answer);
  }
  Marker faces = make_marker({"touched", organ.frame, colours::depth(0.0)}, Marker::TRIANGLE_LIST);
  for (const auto& [face, depth] : depths) {
    add_lifted_face(faces, organ, face, colours::depth(depth / last_colour));
  }
  add_marker(std::move(faces), picture);
}

void add_status(const Scene& scene, const SceneOrgan& organ, MarkerArray& picture) {
  // The text is below the organ, because most tools come from above, and would hide it there. At
  // this distance, the organ does not hide it from a viewer who looks down at 40 degrees.
  constexpr double kDistance = 0.28;  // The distance of the text from the organ's box.
  const Eigen::AlignedBox3d box = organ.mesh->box().cast<double>();
  Vector3d place = box.center();
  place.z() = box.min().z() - kDistance * organ.size();
  const auto add = [&](const std_msgs::ColorRGBA& colour, const std::string& line) {
    place = add_text({"status", organ.frame, colour}, place, organ.size(), line, picture);
  };
  add(colours::kText, organ.name + ": " + counted(organ.mesh->face_count(), "face"));
  for (const ScenePair& pair : organ.pairs) {
    // With many organs and tools, lines about far pairs would hide those about near ones.
    if (scene.organs.size() > 1 && is_far(pair)) continue;
    const bool failed = pair.answer && pair.answer->status != ContactArray::OK;
    add(failed ? colours::kFailure : colours::kText,
        status_line((*scene.tools)[pair.tool].parameters.name, pair.answer));
  }
  if (scene.query_times && scene.query_times->summary().count > 0) {
    // In milliseconds, because the font of RViz has no micro sign.
    const double milliseconds = 1e3 * scene.query_times->summary().median;
    add(colours::kText, rounded("%.3f ms a query", milliseconds));
  }
}

}  // namespace organ_collision
