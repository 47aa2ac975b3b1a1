#include "offline/contacts_csv.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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

FaceContact contact(std::uint32_t face) {
  FaceContact contact;
  contact.face = face;
  contact.fraction = 1.0 / 3.0;
  contact.depth = -0.0025;
  contact.point = {0.1, -2e-10, 1234.5};
  contact.normal = {0.0, 0.6, -0.8};
  return contact;
}

std::string csv_of(QueryMode mode, const CollisionResult& result) {
  Motion motion;
  motion.query = "17";
  motion.mode = mode;
  std::string csv = "before\n";
  append_contacts(motion, result, csv);
  return csv;
}

TEST(ContactsCsv, has_the_columns_of_the_contract) {
  EXPECT_EQ(contacts_header(),
            "query,face,fraction,depth,point_x,point_y,point_z,normal_x,normal_y,normal_z\n");
}

TEST(ContactsCsv, appends_a_line_for_each_contact_with_17_digits) {
  CollisionResult result;
  result.contacts = {contact(3), contact(4000000000U)};
  const std::string rest =
      ",0.33333333333333331,-0.0025000000000000001,0.10000000000000001,-2.0000000000000001e-10,"
      "1234.5,0,0.59999999999999998,-0.80000000000000004\n";
  for (const QueryMode mode : {QueryMode::kStatic, QueryMode::kSwept}) {
    EXPECT_EQ(csv_of(mode, result), "before\n17,3" + rest + "17,4000000000" + rest);
  }
}

TEST(ContactsCsv, leaves_empty_what_paper_modes_do_not_say) {
  CollisionResult result;
  result.contacts = {contact(3)};
  for (const QueryMode mode :
       {QueryMode::kPaperStatic, QueryMode::kPaperSwept, QueryMode::kPaperNaive}) {
    EXPECT_EQ(csv_of(mode, result), "before\n17,3,,,,,,,,\n");
  }
}

TEST(ContactsCsv, has_no_line_for_a_motion_without_contact) {
  EXPECT_EQ(csv_of(QueryMode::kSwept, {}), "before\n");
}

TEST(ContactsCsv, appends_the_columns_that_are_asked_for) {
  const std::string columns = contacts_header().substr(0, contacts_header().size() - 1);
  EXPECT_EQ(contacts_header({true, false}), columns + clearance_columns() + "\n");
  EXPECT_EQ(contacts_header({false, true}), columns + placement_columns() + "\n");
  EXPECT_EQ(contacts_header({true, true}),
            columns + clearance_columns() + placement_columns() + "\n");
}

TEST(ContactsCsv, repeats_added_columns_in_each_line_of_a_motion) {
  CollisionResult result;
  result.clearance.state = ClearanceState::kKnown;
  result.placement.tip = Side::kInside;
  std::string added;
  append_clearance(result.clearance, added);
  append_placement(&result.placement, added);
  Motion motion;
  motion.query = "17";
  motion.mode = QueryMode::kSwept;
  std::string without_contact;
  append_contacts(motion, result, without_contact, {true, true});
  EXPECT_EQ(without_contact, "17,,,,,,,,," + added + "\n");

  result.contacts = {contact(3), contact(4)};
  std::string plain, csv;
  append_contacts(motion, result, plain);
  append_contacts(motion, result, csv, {true, true});
  std::string expected;
  for (const char character : plain) {
    if (character == '\n') expected += added;
    expected += character;
  }
  EXPECT_EQ(csv, expected);
}

TEST(ContactsCsv, leaves_added_columns_empty_in_paper_modes) {
  Motion motion;
  motion.query = "17";
  motion.mode = QueryMode::kPaperSwept;
  std::string csv;
  append_contacts(motion, {}, csv, {true, true});
  const std::string header = contacts_header({true, true});
  EXPECT_EQ(csv, "17" + std::string(std::count(header.begin(), header.end(), ','), ',') + "\n");
}

}  // namespace

}  // namespace organ_collision
