#include "finite.hpp"

#include <algorithm>
#include <cmath>

namespace organ_collision {
namespace {

template <typename... Numbers>
bool are_finite(const Numbers&... numbers) {
  return (std::isfinite(numbers) && ...);
}

template <typename Vector>
bool is_vector_finite(const Vector& v) {
  return are_finite(v.x, v.y, v.z);
}

/// What contacts and clearances have in common.
template <typename Place>
bool is_place_finite(const Place& at) {
  const auto& [a, b, c] = at.barycentric.elems;
  return is_vector_finite(at.on_organ) && is_vector_finite(at.on_tool) &&
         is_vector_finite(at.normal) && are_finite(a, b, c);
}

bool is_contact_finite(const Contact& at) {
  return is_place_finite(at) && is_vector_finite(at.point) && is_vector_finite(at.velocity) &&
         are_finite(at.fraction, at.shaft, at.depth);
}

bool is_clearance_finite(const Clearance& at) {
  return is_place_finite(at) &&
         are_finite(at.margin, at.distance, at.least, at.least_fraction, at.closing_speed);
}

}  // namespace

bool is_finite(const ContactArray& answer) {
  const auto are_contacts_finite = [](const std::vector<Contact>& contacts) {
    return std::all_of(contacts.begin(), contacts.end(), is_contact_finite);
  };
  const auto& crossings = answer.placement.crossings;
  return are_contacts_finite(answer.contacts) && are_contacts_finite(answer.near) &&
         are_contacts_finite(answer.around) && is_clearance_finite(answer.clearance) &&
         are_finite(answer.around_up_to, answer.placement.length_inside) &&
         std::all_of(crossings.begin(), crossings.end(), [](const Crossing& at) {
           return is_vector_finite(at.point) && std::isfinite(at.shaft);
         });
}

}  // namespace organ_collision
