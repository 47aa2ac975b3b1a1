#include "organ_collision/geometry/tolerances.hpp"

#include <gtest/gtest.h>

namespace organ_collision {
namespace {

// What the contacts promise, 1e-9 m, rests on this order.
TEST(Tolerances, AreOrdered) {
  EXPECT_LT(tolerance::kTie, tolerance::kTouch);
  EXPECT_LT(tolerance::kTouch, tolerance::kPierced);
  EXPECT_LE(tolerance::kPierced, 1e-9);
}

}  // namespace
}  // namespace organ_collision
