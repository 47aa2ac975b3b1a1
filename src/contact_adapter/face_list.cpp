#include "face_list.hpp"

#include <algorithm>

namespace organ_collision {

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
