#include "offline/contacts_csv.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

namespace organ_collision {
namespace {

const std::string kClearanceColumns =
    ",clearance,distance,least,least_fraction,nearest_face,on_organ_x,on_organ_y,on_organ_z"
    ",on_tool_x,on_tool_y,on_tool_z,clearance_normal_x,clearance_normal_y,clearance_normal_z"
    ",normal_defined";
const std::string kPlacementColumns =
    ",tip_side,trocar_side,crossings,crossed_faces,crossing_directions,crossing_places"
    ",length_inside";

FaceContact contact(std::uint32_t face) {
  FaceContact contact;
  contact.face = face;
  contact.fraction = 1.0 / 3.0;
  contact.depth = -0.0025;
  contact.point = {0.1, -2e-10, 1234.5};
  contact.normal = {0.0, 0.6, -0.8};
  return contact;
}

const std::string kRest =
    ",0.33333333333333331,-0.0025000000000000001,0.10000000000000001,-2.0000000000000001e-10"
    ",1234.5,0,0.59999999999999998,-0.80000000000000004";

std::string csv_of(QueryMode mode, const CollisionResult& result, AddedColumns added = {}) {
  Motion motion;
  motion.query = "17";
  motion.mode = mode;
  std::string csv;
  append_contacts(motion, result, csv, added);
  return csv;
}

TEST(ContactsCsv, has_the_columns_of_the_contract) {
  const std::string contacts =
      "query,face,fraction,depth,point_x,point_y,point_z,normal_x,normal_y,normal_z";
  EXPECT_EQ(contacts_header(), contacts + '\n');
  EXPECT_EQ(contacts_header({true, false}), contacts + kClearanceColumns + '\n');
  EXPECT_EQ(contacts_header({true, true}), contacts + kClearanceColumns + kPlacementColumns + '\n');
}

TEST(ContactsCsv, has_a_line_for_each_contact_with_17_digits) {
  CollisionResult result;
  EXPECT_EQ(csv_of(QueryMode::kSwept, result), "");
  result.contacts = {contact(3), contact(4000000000U)};
  for (const QueryMode mode : {QueryMode::kStatic, QueryMode::kSwept}) {
    EXPECT_EQ(csv_of(mode, result), "17,3" + kRest + "\n17,4000000000" + kRest + "\n");
  }
  for (const QueryMode mode :
       {QueryMode::kPaperStatic, QueryMode::kPaperSwept, QueryMode::kPaperNaive}) {
    EXPECT_EQ(csv_of(mode, result), "17,3,,,,,,,,\n17,4000000000,,,,,,,,\n");
    EXPECT_EQ(csv_of(mode, {}, {true, true}), "17" + std::string(9 + 15 + 7, ',') + "\n");
  }
}

TEST(ContactsCsv, keeps_every_double) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> exponent(-12.0, 6.0);
  CollisionResult result;
  result.contacts = {contact(3)};
  for (int i = 0; i < 10'000; ++i) {
    const double number = std::pow(10.0, exponent(random)) * (i % 2 == 0 ? 1.0 : -1.0);
    result.contacts[0].fraction = number;
    const std::string csv = csv_of(QueryMode::kStatic, result);
    EXPECT_EQ(std::strtod(csv.c_str() + 5, nullptr), number);
  }
}

TEST(ContactsCsv, has_the_clearance_as_far_as_it_is_known) {
  CollisionResult result;
  const auto cells = [&] {
    const std::string csv = csv_of(QueryMode::kSwept, result, {true, false});
    return csv.substr(csv.find(",,,,,,,,,") + 9);
  };
  EXPECT_EQ(cells(), std::string(15, ',') + "\n");
  ToolClearance& clearance = result.clearance;
  clearance.state = ClearanceState::kKnown;
  clearance.distance = 0.125;
  clearance.least = 0.1;
  clearance.least_fraction = 0.75;
  clearance.face = 4000000000U;
  clearance.on_organ = {1.0, 2.0, 3.0};
  clearance.on_tool = {1.0, 2.0, 2.875};
  clearance.normal = {0.0, 0.0, 1.0};
  clearance.normal_defined = true;
  const std::string rest = ",0.125,0.10000000000000001,0.75,4000000000,1,2,3,1,2,2.875,0,0,1,";
  EXPECT_EQ(cells(), ",known" + rest + "1\n");
  clearance.is_resolved = clearance.normal_defined = false;
  EXPECT_EQ(cells(), ",upper_bound" + rest + "0\n");
  clearance.state = ClearanceState::kBeyondMargin;
  EXPECT_EQ(cells(), ",beyond_margin" + std::string(14, ',') + "\n");
}

AxisCrossing crossing(std::uint32_t face, double shaft, int direction) {
  AxisCrossing crossing;
  crossing.face = face;
  crossing.shaft = shaft;
  crossing.direction = static_cast<std::int8_t>(direction);
  return crossing;
}

TEST(ContactsCsv, has_the_crossings_in_their_order_in_each_line) {
  CollisionResult result;
  EXPECT_EQ(csv_of(QueryMode::kSwept, result, {false, true}),
            "17,,,,,,,,,,unknown,unknown,0,,,,\n");
  result.contacts = {contact(3), contact(4)};
  AxisPlacement& placement = result.placement;
  placement.tip = Side::kOutside;
  placement.trocar = Side::kOnSurface;
  placement.crossings = {crossing(12, 0.1, 1), crossing(0, 0.5, -1), crossing(7, 1.0, 1)};
  placement.length_known = true;
  placement.length_inside = 0.1;
  const std::string added =
      ",outside,on_surface,3,12 0 7,1 -1 1,0.10000000000000001 0.5 1,0.10000000000000001\n";
  EXPECT_EQ(csv_of(QueryMode::kSwept, result, {false, true}),
            "17,3" + kRest + added + "17,4" + kRest + added);
}

}  // namespace
}  // namespace organ_collision
