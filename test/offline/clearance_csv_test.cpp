#include "offline/clearance_csv.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace organ_collision {
namespace {

ToolClearance some_clearance() {
  ToolClearance clearance;
  clearance.state = ClearanceState::kKnown;
  clearance.distance = 0.125;
  clearance.least = 0.1;
  clearance.least_fraction = 0.75;
  clearance.face = 4000000000U;
  clearance.on_organ = {1.0, 2.0, 3.0};
  clearance.on_tool = {1.0, 2.0, 2.875};
  clearance.normal = {0.0, 0.0, 1.0};
  clearance.normal_defined = true;
  return clearance;
}

std::string cells(const ToolClearance& clearance) {
  std::string csv;
  append_clearance(clearance, csv);
  return csv;
}

TEST(ClearanceCsv, has_a_cell_for_each_column) {
  const std::string columns = clearance_columns();
  for (const ClearanceState state :
       {ClearanceState::kNotAsked, ClearanceState::kBeyondMargin, ClearanceState::kKnown}) {
    ToolClearance clearance = some_clearance();
    clearance.state = state;
    const std::string csv = cells(clearance);
    EXPECT_EQ(std::count(csv.begin(), csv.end(), ','),
              std::count(columns.begin(), columns.end(), ','));
  }
}

TEST(ClearanceCsv, prints_all_fields) {
  const std::string rest = ",0.125,0.10000000000000001,0.75,4000000000,1,2,3,1,2,2.875,0,0,1,1";
  ToolClearance clearance = some_clearance();
  EXPECT_EQ(cells(clearance), ",known" + rest);
  clearance.is_resolved = false;
  EXPECT_EQ(cells(clearance), ",upper_bound" + rest);
  clearance.normal_defined = false;
  EXPECT_EQ(cells(clearance).back(), '0');
}

TEST(ClearanceCsv, prints_no_number_that_is_not_known) {
  ToolClearance clearance = some_clearance();
  clearance.state = ClearanceState::kBeyondMargin;
  EXPECT_EQ(cells(clearance), ",beyond_margin" + std::string(14, ','));
  EXPECT_EQ(cells({}), std::string(15, ','));
}

}  // namespace
}  // namespace organ_collision
