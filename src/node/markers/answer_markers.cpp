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
// The places where a shaft's axis enters and leaves an organ. Colour-blind people can tell these
// colours apart, too.
const std_msgs::ColorRGBA kEntering = rgba(1.00F, 0.65F, 0.10F);
const std_msgs::ColorRGBA kLeaving = rgba(0.25F, 0.45F, 1.00F);

// For each pair of organ and tool, only so many are drawn: the arrows of the deepest contacts, the
// nearest faces, and the first crossings from the trocar.
constexpr std::size_t kMostArrows = 30;
constexpr std::size_t kMostNearFaces = 2000;
constexpr std::size_t kMostCrossings = 100;

// In the functions below, lengths are shares of the organ's size, and `share` is how visible
// something is, in [0, 1].

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
void add_normals(const SceneOrgan& organ, const ContactArray& answer, double share,
                 MarkerArray& picture) {
  constexpr double kLength = 0.07;
  std::vector<Contact> deepest(std::min(kMostArrows, answer.contacts.size()));
  std::partial_sort_copy(answer.contacts.begin(), answer.contacts.end(), deepest.begin(),
                         deepest.end(), is_deeper);
  const MarkerStyle style{"normals", organ.frame, colours::faded(kNormal, share)};
  for (const Contact& contact : deepest) {
    add_arrow(style, before(contact, kLength * organ.size()), before(contact, 0.0), {}, picture);
  }
}

/// Adds the name of each link that touches, at its deepest contact. Names near each other share a
/// text, a line each, so that none hides another. A shaft has the name of its tool.
void add_names(const SceneOrgan& organ, const ContactArray& answer, double share,
               MarkerArray& picture) {
  constexpr double kDistance = 0.15;  // The distance of a name from its contact.
  constexpr double kShared = 0.15;    // Names that are nearer to each other share a text.
  std::map<std::int32_t, const Contact*> by_link;
  for (const Contact& contact : answer.contacts) {
    const Contact*& known = by_link[contact.link];
    if (!known || is_deeper(contact, *known)) known = &contact;
  }
  std::vector<std::pair<Vector3d, std::string>> texts;
  for (const auto& [link, contact] : by_link) {
    const Vector3d place = before(*contact, kDistance * organ.size());
    const auto is_near = [&](const auto& text) {
      return (text.first - place).norm() < kShared * organ.size();
    };
    const std::string& name =
        link == kShaft ? answer.tool : answer.links.at(static_cast<std::size_t>(link));
    const auto text = std::find_if(texts.begin(), texts.end(), is_near);
    if (text == texts.end()) {
      texts.emplace_back(place, name);
    } else {
      text->second += "\n" + name;
    }
  }
  const MarkerStyle style{"names", organ.frame, colours::faded(colours::kText, share)};
  for (const auto& [place, text] : texts) add_text(style, place, organ.size(), text, picture);
}

/// Adds the near faces, at their present place: the nearer, the more opaque.
void add_near_faces(const SceneOrgan& organ, const ContactArray& answer, MarkerArray& picture) {
  /// The opacity of a near face at the margin, as a share of that of a face at the tool.
  constexpr double kFaintest = 0.15;
  Marker faces = make_marker({"near", organ.frame, kNearFace}, Marker::TRIANGLE_LIST);
  for (std::size_t i = 0; i < std::min(answer.near.size(), kMostNearFaces); ++i) {
    const double nearness =
        std::clamp(1.0 + answer.near[i].depth / answer.clearance.margin, kFaintest, 1.0);
    add_lifted_face(faces, organ, answer.near[i].face, colours::faded(kNearFace, nearness));
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

/// Adds a cone around the shaft for each place where its axis pierces the organ. The cones point
/// along the axis and stand outside the organ: where the axis enters, the cone ends at the surface,
/// and where it leaves, it begins there. `radius`: the shaft's radius [m].
void add_crossings(const SceneOrgan& organ, const ShaftAxis& axis, double radius,
                   const ToolPlacement& placement, MarkerArray& picture) {
  constexpr double kRadius = 2.5;  // The radius of a cone, as a multiple of the shaft's radius.
  constexpr double kLeastRadius = 0.02;
  constexpr double kLength = 2.0;  // The length of a cone, as a multiple of its radius.
  // An arrow that is nearly all head is a cone. RViz warns of an arrow without a shaft.
  const ArrowShape shape{0.01, 2.0 / kLength, 0.999};
  const double length = kLength * std::max(kRadius * radius, kLeastRadius * organ.size());
  const Vector3d cone = length * axis.along().normalized();
  for (std::size_t i = 0; i < std::min(placement.crossings.size(), kMostCrossings); ++i) {
    const bool enters = placement.crossings[i].direction > 0;
    const Vector3d point = to_eigen(placement.crossings[i].point);
    const Vector3d base = enters ? Vector3d(point - cone) : point;
    add_arrow({"crossings", organ.frame, enters ? kEntering : kLeaving}, base, base + cone, shape,
              picture);
  }
}

/// For example "probe: 3 contacts, 1.2 mm deep, tip inside, 32.1 mm of its axis inside", or "probe:
/// touches nothing, 3.2 mm away". If the step failed, for example "probe: no transform: ...", with
/// the message. `fades`: faces that the tool touched are still shown.
std::string status_line(const std::string& tool, const ContactArrayConstPtr& answer, bool fades) {
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
    line += fades ? "touched a moment ago" : "touches nothing";
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

void add_surroundings(const SceneOrgan& organ, const ScenePair& pair, double radius,
                      MarkerArray& picture) {
  add_near_faces(organ, *pair.answer, picture);
  add_clearance(organ, pair.answer->clearance, picture);
  if (pair.pose) {
    add_crossings(organ, pair.pose->axis, radius, pair.answer->placement, picture);
  }
}

void add_contacts(const SceneOrgan& organ, const ContactArray& answer, double share,
                  MarkerArray& picture) {
  add_regions(organ, answer, picture);
  add_normals(organ, answer, share, picture);
  add_names(organ, answer, share, picture);
}

void add_status(const Scene& scene, const SceneOrgan& organ,
                const std::vector<const SceneStep*>& fading, double query_sec,
                MarkerArray& picture) {
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
  for (std::size_t i = 0; i < organ.pairs.size(); ++i) {
    const ScenePair& pair = organ.pairs[i];
    // With many organs and tools, lines about far pairs would hide those about near ones.
    if (scene.organs.size() > 1 && is_far(pair) && !fading[i]) continue;
    const bool failed = pair.answer && pair.answer->status != ContactArray::OK;
    add(failed ? colours::kFailure : colours::kText,
        status_line((*scene.tools)[pair.tool].parameters.name, pair.answer, fading[i]));
  }
  // In milliseconds, because the font of RViz has no micro sign.
  if (query_sec > 0.0) add(colours::kText, rounded("%.3f ms a query", 1e3 * query_sec));
}

}  // namespace organ_collision
