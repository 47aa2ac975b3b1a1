#pragma once

#include <boost/multiprecision/cpp_int.hpp>

namespace organ_collision {

/// An integer of any size, for the exact predicates. Only a number of more than 512 bits allocates
/// memory. That takes points whose coordinates span 40 orders of magnitude.
using ExactInteger = boost::multiprecision::number<
    boost::multiprecision::cpp_int_backend<512, 0, boost::multiprecision::signed_magnitude,
                                           boost::multiprecision::unchecked>,
    boost::multiprecision::et_off>;

/// A quotient to 62 binary digits, then rounded to a double. Equal fractions give equal numbers.
/// The denominator is positive.
double ratio(const ExactInteger& numerator, const ExactInteger& denominator);

}  // namespace organ_collision
