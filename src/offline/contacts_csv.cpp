#include "contacts_csv.hpp"

#include <cstdio>

namespace organ_collision {
namespace {

void append_number(double number, std::string& csv) {
  char text[32];
  csv.append(text, std::snprintf(text, sizeof text, ",%.17g", number));
}

void append_vector(const Eigen::Vector3d& vector, std::string& csv) {
  for (int axis = 0; axis < 3; ++axis) append_number(vector[axis], csv);
}

}  // namespace

std::string contacts_header() {
  return "query,face,fraction,depth,point_x,point_y,point_z,normal_x,normal_y,normal_z\n";
}

void append_contacts(const Motion& motion, const CollisionResult& result, std::string& csv) {
  for (const FaceContact& contact : result.contacts) {
    csv += motion.query + ',' + std::to_string(contact.face);
    if (is_paper_mode(motion.mode)) {
      csv += ",,,,,,,,";
    } else {
      append_number(contact.fraction, csv);
      append_number(contact.depth, csv);
      append_vector(contact.point, csv);
      append_vector(contact.normal, csv);
    }
    csv += '\n';
  }
}

}  // namespace organ_collision
