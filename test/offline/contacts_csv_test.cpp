#include "offline/contacts_csv.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "offline/clearance_csv.hpp"
#include "offline/placement_csv.hpp"

namespace organ_collision {
namespace {

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
