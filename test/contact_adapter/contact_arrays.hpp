#pragma once

#include <organ_collision/ContactArray.h>
#include <tf2_eigen/tf2_eigen.h>

#include <Eigen/Core>
#include <vector>

#include "ros/interface/conversions.hpp"

namespace organ_collision {

/// A contact of face 0, with geometry. `normal` need not be unit.
inline Contact contact(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double depth) {
  Contact contact;
  contact.point = tf2::toMsg(point);
  contact.normal = to_vector(normal.normalized());
  contact.depth = depth;
  return contact;
}

/// An answer with status OK.
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
