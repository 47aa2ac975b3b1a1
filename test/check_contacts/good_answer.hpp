#pragma once

#include <organ_collision/ContactArray.h>

#include <cstdint>

namespace organ_collision {

inline Contact good_contact(std::uint32_t face, std::uint32_t link) {
  Contact contact;
  contact.face = face;
  contact.vertices = {face, face + 1, face + 2};
  contact.link = link;
  contact.fraction = 0.25;
  contact.normal.y = 0.6;
  contact.normal.z = -0.8;
  contact.barycentric = {0.2, 0.3, 0.5};
  contact.shaft = link == 0 ? 0.75 : 0.0;
  contact.point.x = 0.01;
  contact.end_point.x = 0.02;
  contact.depth = 0.003;
  return contact;
}

inline Contact near_contact(std::uint32_t face, double distance) {
  Contact contact = good_contact(face, 0);
  contact.depth = -distance;
  return contact;
}

inline Clearance good_clearance() {
  Clearance clearance;
  clearance.state = Clearance::KNOWN;
  clearance.margin = 0.05;
  clearance.distance = 0.01;
  clearance.least = 0.0;  // Faces were touched.
  clearance.least_fraction = 0.25;
  clearance.face = 4;
  clearance.barycentric = {0.0, 1.0, 0.0};
  clearance.on_organ.z = -0.01;
  clearance.normal.z = -1.0;
  return clearance;
}

inline ToolPlacement good_placement() {
  ToolPlacement placement;
  placement.tip = ToolPlacement::INSIDE;
  placement.trocar = ToolPlacement::OUTSIDE;
  placement.length_known = true;
  placement.length_inside = 0.02;
  Crossing crossing;
  crossing.barycentric = {0.3, 0.3, 0.4};
  crossing.direction = 1;
  for (const double shaft : {0.5, 0.6}) {
    crossing.shaft = shaft;
    placement.crossings.push_back(crossing);
    crossing.direction = -1;
  }
  return placement;
}

/// A swept answer about a tool with a shaft and a link, in which nothing is wrong.
inline ContactArray good_answer() {
  ContactArray answer;
  answer.header.frame_id = "liver_frame";
  answer.header.stamp = ros::Time(5, 100);
  answer.header.seq = 1;
  answer.step_start = ros::Time(5, 50);
  answer.organ = "liver";
  answer.tool = "grasper";
  answer.links = {"", "jaw"};
  answer.mode = ContactArray::SWEPT;
  answer.contacts = {good_contact(3, 0), good_contact(3, 1), good_contact(7, 0)};
  answer.regions.resize(3);
  answer.near = {near_contact(9, 0.001), near_contact(2, 0.002)};
  answer.clearance = good_clearance();
  answer.placement = good_placement();
  return answer;
}

/// The same at one moment.
inline ContactArray good_static_answer() {
  ContactArray answer = good_answer();
  answer.mode = ContactArray::STATIC;
  answer.step_start = answer.header.stamp;
  for (auto* list : {&answer.contacts, &answer.near}) {
    for (Contact& contact : *list) {
      contact.fraction = 0.0;
      contact.end_point = contact.point;
    }
  }
  answer.clearance.distance = answer.clearance.least = -0.003;
  answer.clearance.least_fraction = 0.0;
  answer.clearance.on_organ.z = 0.003;
  return answer;
}

inline ContactArray good_failure() {
  ContactArray answer;
  answer.header.stamp = ros::Time(5, 100);
  answer.organ = "liver";
  answer.tool = "grasper";
  answer.links = {""};
  answer.status = ContactArray::NO_TRANSFORM;
  answer.message = "frame 'a' is not known";
  return answer;
}

}  // namespace organ_collision
