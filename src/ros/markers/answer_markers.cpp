#include "answer_markers.hpp"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "ros/messages/conversions.hpp"
#include "ros/messages/failure_log.hpp"
#include "ros/messages/text.hpp"
#include "tool_markers.hpp"

namespace organ_collision {
namespace {

using visualization_msgs::Marker;

/// A share of the organ's size.
constexpr double kRegionWidth = 2e-3;

}  // namespace

void TouchedFaces::add(const SceneOrgan& organ, const ContactArray& answer, SteadyTime time) {
  Organ& known = organs_[organ.name];
  if (known.faces != organ.faces) known = {organ.faces, {}};
  for (const Contact& contact : answer.contacts) {
    Touch& touch = known.touches[contact.face];
    touch.depth = touch.time == time ? std::max(touch.depth, contact.depth) : contact.depth;
    touch.time = time;
  }
}

void TouchedFaces::add_markers(const Scene& scene, const SceneOrgan& organ, MarkerSheet& sheet) {
  const auto known = organs_.find(organ.name);
  if (known == organs_.end() || known->second.faces != organ.faces) return;
  Marker faces =
      make_marker(marker_names::kTouched, organ.frame, Marker::TRIANGLE_LIST, colours::depth(0.0));
  auto& touches = known->second.touches;
  for (auto entry = touches.begin(); entry != touches.end();) {
    const auto& [face, touch] = *entry;
    const double share = visibility(touch.time, scene.time);
    if (share == 0.0) {
      entry = touches.erase(entry);
      continue;
    }
    const double depth = touch.depth / scene.settings.markers_depth;
    add_lifted_face(organ, face, colours::faded(colours::depth(depth), share), faces);
    ++entry;
  }
  sheet.add(std::move(faces));
}

void TouchedFaces::forget_others(const Scene& scene) {
  for (auto known = organs_.begin(); known != organs_.end();) {
    known = scene.organ(known->first) ? std::next(known) : organs_.erase(known);
  }
}

void add_regions(const SceneOrgan& organ, const ContactArray& answer, MarkerSheet& sheet) {
  Marker lines =
      make_marker(marker_names::kRegions, organ.frame, Marker::LINE_LIST, colours::region());
  lines.scale.x = kRegionWidth * organ.size();
  const auto add = [&](const geometry_msgs::Point32& corner) {
    add_point(lines, {corner.x, corner.y, corner.z});
  };
  for (const geometry_msgs::Polygon& region : answer.regions) {
    for (std::size_t i = 0; i < region.points.size(); ++i) {
      add(region.points[i]);
      add(region.points[(i + 1) % region.points.size()]);
    }
  }
  sheet.add(std::move(lines));
}

namespace {

using Eigen::Vector3d;

/// Shares of the organ's size.
constexpr double kArrowLength = 0.07;
constexpr double kNameDistance = 0.15;  ///< from the contact
constexpr double kNameHeight = 0.03;

/// The place at `distance` from a contact, on the side of the tool.
Vector3d before(const Contact& contact, double distance) {
  const Vector3d end(contact.end_point.x, contact.end_point.y, contact.end_point.z);
  const Vector3d normal(contact.normal.x, contact.normal.y, contact.normal.z);
  return end - distance * normal;
}

bool is_deeper(const Contact* a, const Contact* b) { return a->depth > b->depth; }

std::vector<const Contact*> deepest(const ContactArray& answer, std::size_t count) {
  std::vector<const Contact*> contacts;
  for (const Contact& contact : answer.contacts) contacts.push_back(&contact);
  const std::size_t kept = std::min(count, contacts.size());
  std::partial_sort(contacts.begin(), contacts.begin() + kept, contacts.end(), is_deeper);
  contacts.resize(kept);
  return contacts;
}

std::string name_of(const ContactArray& answer, std::uint32_t link) {
  const std::string& name = answer.links.at(link);
  return name.empty() ? answer.tool : name;
}

}  // namespace

void add_normals(const SceneOrgan& organ, const ContactArray& answer, double share,
                 MarkerSheet& sheet) {
  Marker arrows = make_marker(marker_names::kNormals, organ.frame, Marker::TRIANGLE_LIST,
                              colours::faded(colours::normal(), share));
  for (const Contact* contact : deepest(answer, kMostArrows)) {
    add_arrow(before(*contact, kArrowLength * organ.size()), before(*contact, 0.0), arrows);
  }
  // RViz lights only markers without colours of their own. It would leave half of the arrows dark.
  arrows.colors.assign(arrows.points.size(), arrows.color);
  sheet.add(std::move(arrows));
}

void add_names(const SceneOrgan& organ, const ContactArray& answer, double share,
               MarkerSheet& sheet) {
  std::map<std::uint32_t, const Contact*> by_link;
  for (const Contact& contact : answer.contacts) {
    const Contact*& known = by_link[contact.link];
    if (!known || is_deeper(&contact, known)) known = &contact;
  }
  for (const auto& [link, contact] : by_link) {
    Marker name = make_marker(marker_names::kNames, organ.frame, Marker::TEXT_VIEW_FACING,
                              colours::faded(colours::text(), share));
    name.text = name_of(answer, link);
    name.pose.position =
        pose_message(
            Eigen::Isometry3d(Eigen::Translation3d(before(*contact, kNameDistance * organ.size()))))
            .position;
    name.scale.z = kNameHeight * organ.size();
    sheet.add(std::move(name));
  }
}

namespace {

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

namespace {

constexpr double kRadius = 2.5;        ///< of a head, as a multiple of the shaft's
constexpr double kLeastRadius = 0.02;  ///< of a head, as a share of the organ's size
constexpr double kLength = 2.0;        ///< of a head, as a multiple of its radius

}  // namespace

void add_crossings(const SceneOrgan& organ, const ShaftAxis& axis, double radius,
                   const ToolPlacement& placement, MarkerSheet& sheet) {
  Marker heads =
      make_marker(marker_names::kCrossings, organ.frame, Marker::TRIANGLE_LIST, colours::text());
  const double head_radius = std::max(kRadius * radius, kLeastRadius * organ.size());
  const Vector3d head = kLength * head_radius * (axis.tip - axis.trocar).normalized();
  const std::size_t count = std::min(placement.crossings.size(), kMostCrossings);
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d point = to_eigen(placement.crossings[i].point);
    const bool enters = placement.crossings[i].direction > 0;
    const Vector3d base = enters ? Vector3d(point - head) : point;
    add_arrow_head(base, base + head, head_radius, heads);
    heads.colors.resize(heads.points.size(), enters ? colours::entering() : colours::leaving());
  }
  sheet.add(std::move(heads));
}

namespace {

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
