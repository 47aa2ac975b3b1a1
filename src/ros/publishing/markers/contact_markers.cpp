#include "contact_markers.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "arrow.hpp"
#include "colours.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using visualization_msgs::Marker;

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

}  // namespace organ_collision
