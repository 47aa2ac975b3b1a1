#pragma once

#include <organ_collision/ContactArray.h>

#include <Eigen/Core>
#include <vector>

#include "ros/interface/conversions.hpp"

namespace organ_collision {

/// A contact with geometry, of face 0; the normal need not be unit.
inline Contact contact(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double depth) {
  Contact contact;
  contact.point = to_point(point);
  contact.normal = to_vector(normal.normalized());
  contact.depth = depth;
  return contact;
}

/// An answer that says OK.
inline ContactArray touched(const std::vector<Contact>& contacts) {
  ContactArray answer;
  answer.header.frame_id = "liver";
  answer.header.stamp = ros::Time(3, 7);
  answer.organ = "liver";
  answer.tool = "hook";
  answer.links = {""};
  answer.mode = ContactArray::SWEPT;
  answer.contacts = contacts;
  return answer;
}

}  // namespace organ_collision
