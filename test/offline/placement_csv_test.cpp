#include "offline/placement_csv.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace organ_collision {
namespace {

AxisCrossing crossing(std::uint32_t face, double shaft, int direction) {
  AxisCrossing crossing;
  crossing.face = face;
  crossing.shaft = shaft;
  crossing.direction = static_cast<std::int8_t>(direction);
  return crossing;
}

std::string cells(const AxisPlacement& placement) {
  std::string csv;
  append_placement(&placement, csv);
  return csv;
}

TEST(PlacementCsv, prints_crossings_in_their_order) {
  AxisPlacement placement;
  placement.tip = Side::kOutside;
  placement.trocar = Side::kOnSurface;
  placement.crossings = {crossing(12, 0.1, 1), crossing(0, 0.5, -1), crossing(7, 1.0, 1)};
  placement.length_known = true;
  placement.length_inside = 0.1;
  EXPECT_EQ(cells(placement),
            ",outside,on_surface,3,12 0 7,1 -1 1,0.10000000000000001 0.5 1,0.10000000000000001");
}

TEST(PlacementCsv, leaves_empty_what_is_not_known) {
  AxisPlacement placement;
  EXPECT_EQ(cells(placement), ",unknown,unknown,0,,,,");
  placement.tip = placement.trocar = Side::kInside;
  placement.length_known = true;
  EXPECT_EQ(cells(placement), ",inside,inside,0,,,,0");
}

TEST(PlacementCsv, has_a_cell_for_each_column) {
  const std::string columns = placement_columns();
  std::string none;
  append_placement(nullptr, none);
  EXPECT_EQ(none, std::string(std::count(columns.begin(), columns.end(), ','), ','));
}

}  // namespace
}  // namespace organ_collision
