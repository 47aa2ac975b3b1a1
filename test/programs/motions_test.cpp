#include "offline/motions.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "temporary_files.hpp"

namespace organ_collision {
namespace {

using Order = MotionList::Order;
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

std::vector<Motion> motions_of(MotionSource&& source) {
  std::vector<Motion> motions;
  while (source.is_ready()) {
    const std::optional<Motion> motion = source.next();
    if (!motion) break;
    motions.push_back(*motion);
  }
  return motions;
}

std::vector<Motion> read(const std::string& content) {
  return motions_of(MotionReader(TemporaryFile(content).path()));
}

std::string refusal(const std::string& content) {
  return refusal_of(content, [](const std::string& file) { motions_of(MotionReader(file)); });
}

TEST(Motion, is_refused_if_it_has_no_answer) {
  for (const auto& [name, mode] : kModes) {
    const Motion good{"7",  3, mode, {0.01, 0.02, 0.2}, {0.03, -0.02, 0.01}, {0.04, 0.01, -0.02},
                      0.005};
    EXPECT_NO_THROW(check(good));
    Motion far = good, wide = good, ball = good;
    far.tip.x() = wide.radius = 1e7;
    EXPECT_THROW(check(far), std::invalid_argument);
    EXPECT_THROW(check(wide), std::invalid_argument);
    ball.previous = ball.tip = ball.trocar;
    if (is_paper_mode(mode)) {
      EXPECT_THROW(check(ball), std::invalid_argument);
    } else {
      EXPECT_NO_THROW(check(ball));
    }
  }
}

TEST(MotionReader, reads_every_mode) {
  for (const auto& [name, mode] : kModes) {
    // The static modes ignore the previous tip.
    const Names previous =
        is_static_mode(mode) ? Names{",,,", ",x,nan,-", ",4,5,6"} : Names{",4,5,6"};
    for (const std::string& cells : previous) {
      const std::vector<Motion> motions =
          read(kHeader + "7," + name + ",1,2,3" + cells + ",7,8,9,0.005\n");
      ASSERT_EQ(motions.size(), 1U);
      const Motion& motion = motions[0];
      EXPECT_EQ(motion.mode, mode);
      EXPECT_EQ(motion.query, "7");
      EXPECT_EQ(motion.line, 2U);
      EXPECT_EQ(motion.radius, 0.005);
      EXPECT_EQ(motion.trocar, Eigen::Vector3d(1, 2, 3));
      EXPECT_EQ(motion.tip, Eigen::Vector3d(7, 8, 9));
      const ToolPath path = path_of(motion);
      ASSERT_EQ(path.size(), is_static_mode(mode) ? 1U : 2U);
      EXPECT_EQ(path.back().axis.trocar, motion.trocar);
      EXPECT_EQ(path.back().axis.tip, motion.tip);
      EXPECT_EQ(path.front().axis.trocar, motion.trocar);
      EXPECT_EQ(path.front().axis.tip,
                is_static_mode(mode) ? motion.tip : Eigen::Vector3d(4, 5, 6));
    }
  }
}

TEST(MotionReader, takes_windows_lines_blank_lines_and_blanks) {
  const std::vector<Motion> motions =
      read("\xEF\xBB\xBF\r\n" + kHeader + "\r\n 1 , static ,1,2, 3,,,,7,8,9, 1e-3 \r\n\r\n2,swept" +
           kPoints + ",1");
  ASSERT_EQ(motions.size(), 2U);
  EXPECT_EQ(motions[0].query, "1");
  EXPECT_EQ(motions[0].line, 4U);
  EXPECT_EQ(motions[0].radius, 1e-3);
  EXPECT_EQ(motions[1].query, "2");
  EXPECT_EQ(motions[1].line, 6U);
}

TEST(MotionReader, refuses_lines_naming_the_value_and_what_is_legal) {
  const std::string none = ": the file ends without a motion; must have at least one";
  const std::string good = kHeader + "1,swept" + kPoints + ",1\n";
  const std::pair<std::string, std::string> refusals[] = {
      {"", ":1" + none},
      {kHeader + "\n", ":2" + none},
      {"query,mode\n",
       ":1: header is \"query,mode\"; must be " + kHeader.substr(0, kHeader.size() - 1)},
      {good + "1,swept" + kPoints + "\n", ":3: 11 columns; must be 12"},
      {good + "1,swept" + kPoints + ",1,\n", ":3: 13 columns; must be 12"},
      {good + ",swept" + kPoints + ",1\n", ":3: query is empty; must be a number or a name"},
      {good + "2,sweep" + kPoints + ",1\n",
       ":3: mode is \"sweep\"; legal are static, swept, paper_static, paper_swept and paper_naive"},
      {good + "2,swept,1,2,3,4,five,6,7,8,9,1\n", ":3: previous_y is \"five\"; must be a number"},
      {good + "2,swept,1,2,,4,5,6,7,8,9,1\n", ":3: trocar_z is \"\"; must be a number"},
      {good + "2,static,1,2,3,4,5,6,nan,8,9,1\n", ":3: tip_x is \"nan\"; must be a finite number"},
      {good + "2,static,-inf,2,3,4,5,6,7,8,9,1\n",
       ":3: trocar_x is \"-inf\"; must be a finite number"},
      {good + "2,static" + kPoints + ",0\n", ":3: radius is \"0\"; must be above 0"},
      {good + "2,static" + kPoints + ",-1e-3\n", ":3: radius is \"-1e-3\"; must be above 0"},
      {good + "2,static" + kPoints + ",inf\n", ":3: radius is \"inf\"; must be a finite number"},
      {good + "2,swept,1,2,3,4,5,6,7,8,1e7,1\n",
       ":3: tip of waypoint 1 is (7, 8, 1e+07); must be finite and within 1e+06 m"}};
  for (const auto& [content, why] : refusals) EXPECT_EQ(refusal(content), why);
  const std::string too_short = refusal(good + "2,paper_swept,1,2,3,1,2,3,1,2,3,1\n");
  EXPECT_EQ(too_short.find(":3: "), 0U) << too_short;
}

TEST(MotionReader, gives_the_motions_before_an_illegal_line) {
  const TemporaryFile file("1,swept" + kPoints + ",1\n2,swept" + kPoints + ",1\n3\n");
  MotionReader reader(file.path());
  EXPECT_EQ(reader.next()->query, "1");
  EXPECT_EQ(reader.next()->query, "2");
  EXPECT_EQ(input_error([&] { reader.next(); }), file.path() + ":3: 1 columns; must be 12");
}

/// A file of motions with these queries.
std::string file_of(const Names& queries) {
  std::string content;
  for (const std::string& query : queries) content += query + ",swept" + kPoints + ",1\n";
  return content;
}

/// The queries in the order in which they are given.
Names given(const Names& queries, Order order) {
  const TemporaryFile file(file_of(queries));
  MotionList list(file.path(), order);
  EXPECT_EQ(list.name(), file.path());
  EXPECT_EQ(list.size(), queries.size());
  Names names;
  for (const Motion& motion : motions_of(std::move(list))) {
    names.push_back(motion.query);
    EXPECT_EQ(queries[motion.line - 1], motion.query);
  }
  return names;
}

TEST(MotionList, sorts_integers_by_value_and_names_as_text) {
  const Names integers{"10", "9", "-3", "0", "100"}, names{"stab", "10", "9", "palpate 2"};
  EXPECT_EQ(given(integers, Order::kByQuery), (Names{"-3", "0", "9", "10", "100"}));
  EXPECT_EQ(given(names, Order::kByQuery), (Names{"10", "9", "palpate 2", "stab"}));
  EXPECT_EQ(given(integers, Order::kAsInFile), integers);
  EXPECT_EQ(given(names, Order::kAsInFile), names);
}

TEST(MotionList, refuses_illegal_files_as_a_whole) {
  const std::pair<std::string, std::string> refusals[] = {
      {file_of({"3", "4", "3"}), ":3: query \"3\" is already on line 1; each motion needs its own"},
      {file_of({"3", "03"}), ":2: query \"03\" is already on line 1; each motion needs its own"},
      {file_of({"a", "b", "b"}), ":3: query \"b\" is already on line 2; each motion needs its own"},
      {file_of({"1", "2"}) + "3,swept\n", ":3: 2 columns; must be 12"}};
  for (const Order order : {Order::kByQuery, Order::kAsInFile}) {
    for (const auto& [content, why] : refusals) {
      EXPECT_EQ(refusal_of(content, [&](const std::string& file) { MotionList(file, order); }),
                why);
    }
  }
}

}  // namespace
}  // namespace organ_collision
