#include "offline/natural_order.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace organ_collision {
namespace {

void expect_order(const std::vector<std::string>& names) {
  for (std::size_t a = 0; a < names.size(); ++a) {
    for (std::size_t b = 0; b < names.size(); ++b) {
      EXPECT_EQ(is_naturally_before(names[a], names[b]), a < b) << names[a] << ", " << names[b];
    }
  }
}

TEST(NaturalOrder, takes_numbers_by_value_and_all_else_as_text) {
  expect_order({"step_2.obj", "step_10.obj", "step_100.obj"});
  expect_order({"a", "a0", "a1", "a1b", "a01c", "a2", "a10", "b"});
  expect_order({"run1_9", "run1_10", "run2_1", "run10_1"});
  expect_order({"", "-", "1", "A", "a", "\xC3\xA9"});
}

TEST(NaturalOrder, takes_numbers_of_any_length) {
  expect_order({"99999999999999999999998", "99999999999999999999999", "100000000000000000000000"});
}

TEST(NaturalOrder, orders_equal_numbers_as_text) {
  expect_order({"0.obj", "00.obj", "01.obj", "1.obj", "2.obj", "10.obj"});
}

}  // namespace
}  // namespace organ_collision
