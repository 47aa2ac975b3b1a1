#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Vector3.h>

#include <boost/array.hpp>
#include <cstddef>
#include <cstdint>
#include <ostream>

#include "faults.hpp"

namespace organ_collision {

/// What a rule is checked on, for its sentence: "contacts[3] (face 17)".
struct CheckedPlace {
  const char* list;
  std::size_t index;
  std::uint32_t face;
};

std::ostream& operator<<(std::ostream& stream, const CheckedPlace& place);

// The rules of single fields. Each adds a fault if its rule is broken.

void check_finite(const CheckedPlace& place, const char* field, double value, Faults& faults);
void check_finite(const CheckedPlace& place, const char* field, const geometry_msgs::Point& value,
                  Faults& faults);
/// In [0, 1].
void check_share(const CheckedPlace& place, const char* field, double value, Faults& faults);
/// Of length 1, to within 1e-6.
void check_unit(const CheckedPlace& place, const geometry_msgs::Vector3& normal, Faults& faults);
/// In [0, 1] with the sum 1, to within 1e-6.
void check_barycentric(const CheckedPlace& place, const boost::array<double, 3>& barycentric,
                       Faults& faults);
/// The index of one of the tool's links.
void check_link(const CheckedPlace& place, std::uint32_t link, std::size_t links, Faults& faults);
/// A face that an organ may have.
void check_face(const CheckedPlace& place, Faults& faults);

}  // namespace organ_collision
