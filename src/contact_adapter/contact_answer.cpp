#include "contact_answer.hpp"

#include <xmlrpcpp/XmlRpcException.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "common/messages/conversions.hpp"
#include "common/messages/failure_log.hpp"
#include "common/messages/text.hpp"
#include "geometry/concatenate.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using XmlRpc::XmlRpcValue;

constexpr double kUnitTolerance = 1e-6;  // [1]

template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  throw Rejection(ContactArray::INVALID_REQUEST, "malformed contacts", concatenate(parts...));
}

void refuse_illegal_name(const char* what, const std::string& name) {
  const std::string fault = name_fault(name);
  if (!fault.empty()) refuse(what, " ", fault);
}

/// Refuses a value unless `is_legal`. `legal`: what is legal. `what`: the parts of the value's
/// name, which are put together only for a refusal.
template <typename Value, typename... What>
void check(bool is_legal, const Value& value, const char* legal, const What&... what) {
  if (!is_legal) refuse(what..., " is ", value, "; must be ", legal);
}

template <typename... What>
void check_place(const geometry_msgs::Point& place, const What&... what) {
  const Vector3d value = to_eigen(place);
  check(value.allFinite(), value.transpose(), "finite", what...);
}

template <typename... What>
void check_normal(const geometry_msgs::Vector3& normal, const What&... what) {
  const Vector3d value = to_eigen(normal);
  check(std::abs(value.norm() - 1.0) <= kUnitTolerance, value.transpose(), "unit", what...);
}

template <typename... What>
void check_link(std::int32_t link, const ContactArray& answer, const What&... what) {
  if (link >= kShaftLink && link < static_cast<std::int64_t>(answer.links.size())) return;
  refuse(what..., " is ", link, "; must be -1 for the shaft, or one of the ", answer.links.size(),
         " links, counted from 0");
}

void check_geometry(const ContactArray& answer) {
  for (const Contact& contact : answer.contacts) {
    check_link(contact.link, answer, "link of face ", contact.face);
    check_place(contact.point, "point of face ", contact.face);
    check_place(contact.on_organ, "on_organ of face ", contact.face);
    check(std::isfinite(contact.depth), contact.depth, "finite", "depth of face ", contact.face);
    check_normal(contact.normal, "normal of face ", contact.face);
  }
  const Clearance& clearance = answer.clearance;
  if (clearance.state != Clearance::KNOWN) return;
  const double distance = clearance.distance;
  check(std::isfinite(distance), distance, "finite", "distance of the clearance");
  check_link(clearance.link, answer, "link of the clearance");
  check_place(clearance.on_organ, "on_organ of the clearance");
  check_normal(clearance.normal, "normal of the clearance");
}

}  // namespace

bool has_geometry(const ContactArray& contacts) {
  return !is_paper_mode(static_cast<QueryMode>(contacts.mode));
}

void check_contacts(const ContactArray& contacts) {
  if (contacts.mode > ContactArray::PAPER_NAIVE) {
    refuse("mode is ", int{contacts.mode}, "; legal are 0 to ", int{ContactArray::PAPER_NAIVE});
  }
  if (contacts.header.frame_id.empty()) refuse("frame_id is empty; must be the organ's frame");
  refuse_illegal_name("frame_id", contacts.header.frame_id);
  refuse_illegal_name("organ", contacts.organ);
  refuse_illegal_name("tool", contacts.tool);
  if (contacts.unresolved > 0) {
    throw Rejection(ContactArray::INVALID_REQUEST, "unresolved contacts",
                    std::to_string(contacts.unresolved) +
                        " contacts were not resolved; no force follows from their depths");
  }
  const std::size_t regions = contacts.regions.size();
  if (regions != 0 && regions != contacts.contacts.size()) {
    refuse(regions, " regions of ", contacts.contacts.size(), " contacts; must be none or as many");
  }
  if (has_geometry(contacts)) check_geometry(contacts);
}

std_msgs::UInt32MultiArray face_list(const ContactArray& contacts) {
  std_msgs::UInt32MultiArray faces;
  for (const Contact& contact : contacts.contacts) faces.data.push_back(contact.face);
  // A face has one contact for each link that touches it.
  std::sort(faces.data.begin(), faces.data.end());
  faces.data.erase(std::unique(faces.data.begin(), faces.data.end()), faces.data.end());

  faces.layout.dim.resize(1);
  faces.layout.dim[0].label = "faces";
  faces.layout.dim[0].size = faces.data.size();
  faces.layout.dim[0].stride = faces.data.size();
  return faces;
}

std::string doubt_about_side(const ContactArray& contacts) {
  const ToolPlacement& placement = contacts.placement;
  const bool is_outside = placement.tip == ToolPlacement::OUTSIDE ||
                          placement.trocar == ToolPlacement::OUTSIDE ||
                          !placement.crossings.empty();
  if (!contacts.contacts.empty() || is_outside) return {};
  const bool has_shaft = contacts.links.empty();
  if (placement.tip == ToolPlacement::UNKNOWN ||
      (has_shaft && placement.trocar == ToolPlacement::UNKNOWN)) {
    return "nothing is touched, and it is not known whether the tool is inside (placement.tip or "
           "placement.trocar is UNKNOWN): a tool inside would be pushed out";
  }
  if (contacts.clearance.state != Clearance::NOT_ASKED) return {};
  return "nothing is touched, the tool is inside, and its way out is not known, because the tool "
         "has no margin";
}

ShaftRadius shaft_radius(const XmlRpcValue& tools, const std::string& tool) {
  try {
    for (int i = 0; i < tools.size(); ++i) {
      const XmlRpcValue &name = tools[i][names::kToolName], &radius = tools[i][names::kRadius];
      if (static_cast<std::string>(name) != tool) continue;
      const bool is_integer = radius.getType() == XmlRpcValue::TypeInt;
      const double number = is_integer ? static_cast<int>(radius) : static_cast<double>(radius);
      return number > 0.0 ? ShaftRadius(number) : std::nullopt;
    }
  } catch (const XmlRpc::XmlRpcException&) {  // This is no list of tools, or the radius is missing.
  }
  return std::nullopt;
}

ShaftRadius radius_at(const Contact& contact, const ShaftRadius& shaft_radius) {
  return contact.link == kShaftLink ? shaft_radius : std::nullopt;
}

}  // namespace organ_collision
