#include "test/proof/proxy/passage_oracle.hpp"

#include <gtest/gtest.h>

#include "geometry/distance/first_touch.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision::oracle {
namespace {

Triangle random_face(Random& random) {
  return {random.point(0.05), random.point(0.05), random.point(0.05)};
}

ShaftAxis random_axis(Random& random) { return {random.point(0.1), random.point(0.1)}; }

/// The library's first touch is a different search. Both have a tolerance, so motions that come
/// within a micrometre of the distance are left to either.
TEST(PassageOracle, AgreesWithFirstTouch) {
  Random random(1);
  long passed = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const ShaftMotion segment{random_axis(random), random_axis(random)};
    const Triangle before = random_face(random), now = random_face(random);
    const double distance = random.scale(1e-5, 0.05);
    const bool passes = oracle::passes(segment, before, now, distance);
    const CoreMotion core(segment);
    if (passes) {
      ++passed;
      EXPECT_TRUE(first_touch(core, {before, now}, distance + 1e-6)) << "trial " << trial;
    } else {
      EXPECT_FALSE(first_touch(core, {before, now}, distance - 1e-6)) << "trial " << trial;
    }
  }
  EXPECT_GT(passed, 300);
  EXPECT_LT(passed, 2700);
}

}  // namespace
}  // namespace organ_collision::oracle
