#include "exact_integer.hpp"

#include <cmath>
#include <cstdint>

namespace organ_collision {

double ratio(const ExactInteger& numerator, const ExactInteger& denominator) {
  constexpr int kDigits = 62;
  if (numerator.is_zero()) return 0.0;
  const ExactInteger magnitude = abs(numerator);
  // The quotient of both, shifted like this, has kDigits or one more.
  int shift = kDigits - static_cast<int>(msb(magnitude)) + static_cast<int>(msb(denominator));
  const ExactInteger quotient = shift >= 0 ? ExactInteger((magnitude << shift) / denominator)
                                           : ExactInteger(magnitude / (denominator << -shift));
  auto digits = static_cast<std::int64_t>(quotient);
  if (msb(quotient) == kDigits) {
    digits /= 2;
    --shift;
  }
  const double result = std::ldexp(static_cast<double>(digits), -shift);
  return numerator.sign() < 0 ? -result : result;
}

}  // namespace organ_collision
