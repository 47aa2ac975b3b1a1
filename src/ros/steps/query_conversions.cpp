#include "query_conversions.hpp"

#include <tf2_eigen/tf2_eigen.h>

#include "ros/interface/conversions.hpp"

namespace organ_collision {
namespace {

// The messages have the numbers of the enumerations.
static_assert(Clearance::NOT_ASKED == static_cast<int>(ClearanceState::kNotAsked) &&
              Clearance::BEYOND_MARGIN == static_cast<int>(ClearanceState::kBeyondMargin) &&
              Clearance::KNOWN == static_cast<int>(ClearanceState::kKnown));
static_assert(ToolPlacement::UNKNOWN == static_cast<int>(Side::kUnknown) &&
              ToolPlacement::OUTSIDE == static_cast<int>(Side::kOutside) &&
              ToolPlacement::INSIDE == static_cast<int>(Side::kInside) &&
              ToolPlacement::ON_SURFACE == static_cast<int>(Side::kOnSurface));

/// Sets the fields that name a place on a face.
template <typename Source, typename Message>
void set_place(const Source& source, Message& message) {
  message.face = source.face;
  for (std::size_t i = 0; i < 3; ++i) message.vertices[i] = source.vertices[i];
  for (std::size_t i = 0; i < 3; ++i) message.barycentric[i] = source.barycentric[i];
}

}  // namespace

Contact to_message(const FaceContact& contact) {
  Contact message;
  set_place(contact, message);
  message.link = contact.link;
  message.fraction = contact.fraction;
  message.point = tf2::toMsg(contact.point);
  message.normal = to_vector(contact.normal);
  message.shaft = contact.shaft;
  message.depth = contact.depth;
  message.behind = contact.behind;
  message.end_point = tf2::toMsg(contact.end_point);
  message.view_min = contact.view_min;
  message.view_max = contact.view_max;
  return message;
}

Clearance to_message(const ToolClearance& clearance) {
  Clearance message;
  set_place(clearance, message);
  message.state = static_cast<std::uint8_t>(clearance.state);
  message.margin = clearance.margin;
  message.unlimited = clearance.unlimited;
  message.distance = clearance.distance;
  message.least = clearance.least;
  message.least_fraction = clearance.least_fraction;
  message.link = clearance.link;
  message.on_organ = tf2::toMsg(clearance.on_organ);
  message.on_tool = tf2::toMsg(clearance.on_tool);
  message.normal = to_vector(clearance.normal);
  message.normal_defined = clearance.normal_defined;
  message.unresolved = !clearance.is_resolved;
  return message;
}

Crossing to_message(const AxisCrossing& crossing) {
  Crossing message;
  set_place(crossing, message);
  message.shaft = crossing.shaft;
  message.point = tf2::toMsg(crossing.point);
  message.direction = crossing.direction;
  return message;
}

ToolPlacement to_message(const AxisPlacement& placement) {
  ToolPlacement message;
  message.tip = static_cast<std::uint8_t>(placement.tip);
  message.trocar = static_cast<std::uint8_t>(placement.trocar);
  message.crossings.reserve(placement.crossings.size());
  for (const AxisCrossing& crossing : placement.crossings) {
    message.crossings.push_back(to_message(crossing));
  }
  message.length_known = placement.length_known;
  message.length_inside = placement.length_inside;
  return message;
}

geometry_msgs::Polygon to_message(const Region& region) {
  geometry_msgs::Polygon message;
  message.points.resize(region.size());
  for (std::size_t i = 0; i < region.size(); ++i) {
    message.points[i].x = static_cast<float>(region[i].x());
    message.points[i].y = static_cast<float>(region[i].y());
    message.points[i].z = static_cast<float>(region[i].z());
  }
  return message;
}

}  // namespace organ_collision
