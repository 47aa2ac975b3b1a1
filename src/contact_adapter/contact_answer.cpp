#include "contact_answer.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "geometry/concatenate.hpp"
#include "organ_collision/query/query_mode.hpp"
#include "organ_collision/ros/names.hpp"
#include "ros/messages/conversions.hpp"
#include "ros/messages/failure_log.hpp"
#include "ros/messages/text.hpp"

namespace organ_collision {
namespace {

constexpr double kUnitTolerance = 1e-6;  // [1]

template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  throw Rejection(ContactArray::INVALID_REQUEST, "malformed contacts", concatenate(parts...));
}

void refuse_illegal_name(const char* what, const std::string& name) {
  const std::string fault = name_fault(name);
  if (!fault.empty()) refuse(what, " ", fault);
}

void check_geometry(const Contact& contact) {
  const Eigen::Vector3d point = to_eigen(contact.point);
  const Eigen::Vector3d normal = to_eigen(contact.normal);
  if (!point.allFinite()) {
    refuse("point of face ", contact.face, " is ", point.transpose(), "; must be finite");
  }
  const Eigen::Vector3d end_point = to_eigen(contact.end_point);
  if (!end_point.allFinite()) {
    refuse("end_point of face ", contact.face, " is ", end_point.transpose(), "; must be finite");
  }
  if (!std::isfinite(contact.depth)) {
    refuse("depth of face ", contact.face, " is ", contact.depth, "; must be finite");
  }
  if (!(std::abs(normal.norm() - 1.0) <= kUnitTolerance)) {
    refuse("normal of face ", contact.face, " is ", normal.transpose(), "; must be unit");
  }
}

void check_clearance(const Clearance& clearance) {
  const Eigen::Vector3d place = to_eigen(clearance.on_organ), normal = to_eigen(clearance.normal);
  if (!std::isfinite(clearance.distance)) {
    refuse("distance of the clearance is ", clearance.distance, "; must be finite");
  }
  if (!place.allFinite()) {
    refuse("on_organ of the clearance is ", place.transpose(), "; must be finite");
  }
  if (!(std::abs(normal.norm() - 1.0) <= kUnitTolerance)) {
    refuse("normal of the clearance is ", normal.transpose(), "; must be unit");
  }
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
  if (!has_geometry(contacts)) return;
  for (const Contact& contact : contacts.contacts) check_geometry(contact);
  if (contacts.clearance.state == Clearance::KNOWN) check_clearance(contacts.clearance);
}

namespace {

using XmlRpc::XmlRpcValue;

std::optional<double> positive_number(const XmlRpcValue& value) {
  double number = 0.0;
  if (value.getType() == XmlRpcValue::TypeInt) number = static_cast<int>(value);
  if (value.getType() == XmlRpcValue::TypeDouble) number = static_cast<double>(value);
  if (number > 0.0) return number;
  return std::nullopt;
}

bool is_named(const XmlRpcValue& entry, const std::string& tool) {
  if (entry.getType() != XmlRpcValue::TypeStruct || !entry.hasMember(names::kToolName))
    return false;
  const XmlRpcValue& name = entry[names::kToolName];
  return name.getType() == XmlRpcValue::TypeString && static_cast<std::string>(name) == tool;
}

}  // namespace

std::optional<double> shaft_radius(const XmlRpcValue& tools, const std::string& tool) {
  if (tools.getType() != XmlRpcValue::TypeArray) return std::nullopt;
  for (int i = 0; i < tools.size(); ++i) {
    if (!is_named(tools[i], tool)) continue;
    return tools[i].hasMember(names::kRadius) ? positive_number(tools[i][names::kRadius])
                                              : std::nullopt;
  }
  return std::nullopt;
}

bool is_shaft(std::uint32_t link, const ContactArray& answer) {
  return link < answer.links.size() && answer.links[link].empty();
}

std::optional<double> radius_at(const Contact& contact, const ContactArray& answer,
                                const std::optional<double>& shaft_radius) {
  return is_shaft(contact.link, answer) ? shaft_radius : std::nullopt;
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

}  // namespace organ_collision
