#include "answer_check.hpp"

#include <cmath>
#include <utility>

namespace organ_collision::stress {
namespace {

bool is_finite(const geometry_msgs::Point& point) {
  return std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z);
}

bool is_unit(const geometry_msgs::Vector3& vector) {
  const double squared = vector.x * vector.x + vector.y * vector.y + vector.z * vector.z;
  return std::abs(squared - 1.0) < 1e-6;
}

std::string broken_contract(const Contact& contact, const ContactArray& answer) {
  if (contact.link >= answer.links.size()) return "a link without a name";
  if (!is_finite(contact.point) || !is_finite(contact.end_point)) return "a point is not finite";
  if (!is_unit(contact.normal)) return "a normal is no unit vector";
  if (!std::isfinite(contact.depth)) return "a depth is not finite";
  if (!(contact.fraction >= 0.0 && contact.fraction <= 1.0)) return "a fraction outside [0, 1]";
  return "";
}

}  // namespace

std::string broken_contract(const ContactArray& answer) {
  if (answer.status > ContactArray::INVALID_TOOL) return "an unknown status";
  if (answer.status != ContactArray::OK) {
    if (answer.message.empty()) return "a failure without a message";
    return answer.contacts.empty() ? "" : "a failure with contacts";
  }
  if (!answer.message.empty()) return "OK with a message";
  for (std::size_t i = 0; i < answer.contacts.size(); ++i) {
    const Contact& contact = answer.contacts[i];
    const std::string broken = broken_contract(contact, answer);
    if (!broken.empty()) return broken;
    if (i == 0) continue;
    const Contact& before = answer.contacts[i - 1];
    if (std::pair(before.face, before.link) >= std::pair(contact.face, contact.link)) {
      return "contacts out of order";
    }
  }
  return "";
}

}  // namespace organ_collision::stress
