#include "offline/csv_cells.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

namespace organ_collision {
namespace {

TEST(CsvCells, keep_every_double) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> exponent(-12.0, 6.0);
  for (int i = 0; i < 10'000; ++i) {
    const double number = std::pow(10.0, exponent(random)) * (i % 2 == 0 ? 1.0 : -1.0);
    EXPECT_EQ(std::strtod(number_text(number).c_str(), nullptr), number);
  }
}

TEST(CsvCells, are_appended_behind_a_comma) {
  std::string csv = "1";
  append_cell("known", csv);
  append_cell(0.1, csv);
  append_cells({1.5, -2.0, 1.0 / 3.0}, csv);
  append_empty_cells(2, csv);
  EXPECT_EQ(csv, "1,known,0.10000000000000001,1.5,-2,0.33333333333333331,,");
}

}  // namespace
}  // namespace organ_collision
