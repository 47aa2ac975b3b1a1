// What query_offline reads and writes: files of motions, and the CSV lines of answers.
// query_offline_answers_test.py compares whole runs of the program.
#include <gtest/gtest.h>

#include "programs/query_offline/contacts_csv.hpp"
#include "programs/query_offline/motions.hpp"
#include "temporary_files.hpp"

namespace organ_collision {
namespace {

/// The beginning of a file, and the end of the message that refuses it.
using Refusals = std::vector<std::pair<std::string, std::string>>;

using Names = std::vector<std::string>;

const std::pair<const char*, QueryMode> kModes[] = {{"static", QueryMode::kStatic},
                                                    {"swept", QueryMode::kSwept},
                                                    {"paper_static", QueryMode::kPaperStatic},
                                                    {"paper_swept", QueryMode::kPaperSwept},
                                                    {"paper_naive", QueryMode::kPaperNaive}};
const std::string kHeader =
    "query,mode,trocar_x,trocar_y,trocar_z,previous_x,previous_y,previous_z,tip_x,tip_y,tip_z,"
    "radius\n";
const std::string kPoints = ",1,2,3,4,5,6,7,8,9";

TEST(Motions, have_every_mode) {
  for (const auto& [name, mode] : kModes) {
    // The static modes ignore the previous tip.
    const bool is_static = is_static_mode(mode);
    for (const std::string& cells :
         is_static ? Names{",,,", ",x,nan,-", ",4,5,6"} : Names{",4,5,6"}) {
      const TemporaryFile file("\xEF\xBB\xBF\r\n" + kHeader + "\r\n 7 , " + name + ",1,2, 3" +
                               cells + ",7,8,9, 1e-3 \r\n\r\n");
      Motions motions(file.path());
      EXPECT_EQ(motions.count(), 1U);
      const Motion motion = motions.next().value();
      EXPECT_FALSE(motions.next());
      EXPECT_EQ(motion.mode, mode);
      EXPECT_EQ(motion.query, "7");
      EXPECT_EQ(motion.line, 4U);
      EXPECT_EQ(motion.radius, 1e-3);
      const ToolPath path = request_of(motion, {}).path;
      ASSERT_EQ(path.size(), is_static ? 1U : 2U);
      EXPECT_EQ(path.back().axis.trocar, Eigen::Vector3d(1, 2, 3));
      EXPECT_EQ(path.back().axis.tip, Eigen::Vector3d(7, 8, 9));
      EXPECT_EQ(path.front().axis.trocar, Eigen::Vector3d(1, 2, 3));
      EXPECT_EQ(path.front().axis.tip,
                is_static ? Eigen::Vector3d(7, 8, 9) : Eigen::Vector3d(4, 5, 6));
    }
  }
}

TEST(Motions, refuse_lines_naming_the_value_and_what_is_legal) {
  const std::string none = ": the file ends without a motion; must have at least one";
  const std::string good = kHeader + "1,swept" + kPoints + ",1\n3,static,1,2,3,,,,1,2,3,1\n";
  const Refusals refusals = {
      {"", ":1" + none},
      {kHeader + "\n", ":2" + none},
      {"query,mode\n", ":1: header is \"query,mode\"; must be " +
                           kHeader.substr(0, kHeader.size() - 1) +
                           ", and perhaps previous_trocar_x,previous_trocar_y,previous_trocar_z"},
      {good + "1,swept" + kPoints + "\n",
       ":4: 11 columns; must be 12, or 15 with the previous trocar"},
      {good + "1,swept" + kPoints + ",1,\n",
       ":4: 13 columns; must be 12, or 15 with the previous trocar"},
      {good + ",swept" + kPoints + ",1\n", ":4: query is empty; must be a number or a name"},
      {good + "2,sweep" + kPoints + ",1\n",
       ":4: mode is \"sweep\"; legal are static, swept, paper_static, paper_swept and paper_naive"},
      {good + "2,swept,1,2,3,4,five,6,7,8,9,1\n", ":4: previous_y is \"five\"; must be a number"},
      {good + "2,swept,1,2,,4,5,6,7,8,9,1\n", ":4: trocar_z is \"\"; must be a number"},
      {good + "2,static,1,2,3,4,5,6,nan,8,9,1\n", ":4: tip_x is \"nan\"; must be a finite number"},
      {good + "2,static" + kPoints + ",0\n", ":4: radius is \"0\"; must be above 0"},
      {good + "2,static" + kPoints + ",-1e-3\n", ":4: radius is \"-1e-3\"; must be above 0"},
      {good + "2,static" + kPoints + ",inf\n", ":4: radius is \"inf\"; must be a finite number"},
      {good + "2,swept,1,2,3,4,5,6,7,8,1e7,1\n",
       ":4: tip of waypoint 1 is (7, 8, 1e+07); must be finite and within 1e+06 m"}};
  const auto read = [](const std::string& file) { Motions motions(file); };
  for (const auto& [content, why] : refusals) EXPECT_EQ(refusal_of(content, read), why);
  for (const char* mode : {"paper_static", "paper_swept", "paper_naive"}) {
    const std::string point = good + "2," + mode + ",1,2,3,1,2,3,1,2,3,1\n";
    EXPECT_EQ(refusal_of(point, read).find(":4: "), 0U);
  }
}

/// A file of motions with these queries.
std::string file_of(const Names& queries) {
  std::string content;
  for (const std::string& query : queries) content += query + ",swept" + kPoints + ",1\n";
  return content;
}

TEST(Motions, are_sorted_as_integers_or_as_text) {
  for (const auto& [queries, sorted] :
       {std::pair(Names{"10", "9", "-3", "0", "100"}, Names{"-3", "0", "9", "10", "100"}),
        std::pair(Names{"stab", "10", "9", "palpate 2"}, Names{"10", "9", "palpate 2", "stab"})}) {
    Motions motions(TemporaryFile(file_of(queries)).path());
    EXPECT_EQ(motions.count(), queries.size());
    Names names;
    while (const std::optional<Motion> motion = motions.next()) {
      names.push_back(motion->query);
      EXPECT_EQ(queries[motion->line - 1], motion->query);
    }
    EXPECT_EQ(names, sorted);
  }
}

std::string csv_of(QueryMode mode, const CollisionResult& result, bool clearance, bool placement) {
  Motion motion;
  motion.query = "17";
  motion.mode = mode;
  QueryOptions asked;
  asked.clearance = clearance;
  asked.placement = placement;
  std::string csv;
  append_contacts(motion, result, asked, csv);
  return csv;
}

TEST(ContactsCsv, has_the_clearance_as_far_as_it_is_known) {
  CollisionResult result;
  const auto cells = [&] { return csv_of(QueryMode::kSwept, result, true, false).substr(2 + 9); };
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

TEST(ContactsCsv, has_the_crossings_in_their_order_in_each_line) {
  CollisionResult result;
  EXPECT_EQ(csv_of(QueryMode::kSwept, result, false, true), "17,,,,,,,,,,unknown,unknown,0,,,,\n");
  result.contacts.resize(2);
  result.contacts[0].face = 3;
  result.contacts[1].face = 4000000000U;
  for (FaceContact& contact : result.contacts) {
    contact.fraction = 1.0 / 3.0;
    contact.depth = -0.0025;
    contact.point = {0.1, -2e-10, 1234.5};
    contact.normal = {0.0, 0.6, -0.8};
  }
  AxisPlacement& placement = result.placement;
  placement.tip = Side::kOutside;
  placement.trocar = Side::kOnSurface;
  placement.crossings.resize(3);
  placement.crossings[0].face = 12;
  placement.crossings[1].shaft = 0.5;
  for (AxisCrossing& crossing : placement.crossings) crossing.direction = 1;
  placement.crossings[1].direction = -1;
  placement.crossings[2].shaft = 0.1;
  placement.length_known = true;
  placement.length_inside = 0.1;
  const std::string rest =
      ",0.33333333333333331,-0.0025000000000000001,0.10000000000000001,-2.0000000000000001e-10"
      ",1234.5,0,0.59999999999999998,-0.80000000000000004"
      ",outside,on_surface,3,12 0 0,1 -1 1,0 0.5 0.10000000000000001,0.10000000000000001\n";
  EXPECT_EQ(csv_of(QueryMode::kSwept, result, false, true), "17,3" + rest + "17,4000000000" + rest);
  EXPECT_EQ(csv_of(QueryMode::kPaperSwept, result, true, true),
            "17,3" + std::string(8 + 15 + 7, ',') + "\n17,4000000000" +
                std::string(8 + 15 + 7, ',') + "\n");
}

}  // namespace
}  // namespace organ_collision
