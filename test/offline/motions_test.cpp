#include "offline/motions.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "temporary_files.hpp"

namespace organ_collision {
namespace {

constexpr QueryMode kModes[] = {QueryMode::kStatic, QueryMode::kSwept, QueryMode::kPaperStatic,
                                QueryMode::kPaperSwept, QueryMode::kPaperNaive};

Motion motion(QueryMode mode) {
  return {"7", 3, mode, {0.01, 0.02, 0.2}, {0.03, -0.02, 0.01}, {0.04, 0.01, -0.02}, 0.005};
}

TEST(Motion, sweeps_the_tip_about_a_resting_trocar) {
  const Motion swept = motion(QueryMode::kSwept);
  const ToolPath path = path_of(swept);
  ASSERT_EQ(path.size(), 2U);
  EXPECT_EQ(path[0].fraction, 0.0);
  EXPECT_EQ(path[0].axis.trocar, swept.trocar);
  EXPECT_EQ(path[0].axis.tip, swept.previous);
  EXPECT_EQ(path[1].fraction, 1.0);
  EXPECT_EQ(path[1].axis.trocar, swept.trocar);
  EXPECT_EQ(path[1].axis.tip, swept.tip);
}

TEST(Motion, has_one_waypoint_in_static_modes) {
  for (const QueryMode mode : {QueryMode::kStatic, QueryMode::kPaperStatic}) {
    const ToolPath path = path_of(motion(mode));
    ASSERT_EQ(path.size(), 1U);
    EXPECT_EQ(path[0].axis.trocar, motion(mode).trocar);
    EXPECT_EQ(path[0].axis.tip, motion(mode).tip);
  }
}

TEST(Motion, is_refused_if_it_has_no_answer) {
  for (const QueryMode mode : kModes) {
    EXPECT_NO_THROW(check(motion(mode)));
    Motion far = motion(mode);
    far.tip.x() = 1e7;
    EXPECT_THROW(check(far), std::invalid_argument);
    Motion wide = motion(mode);
    wide.radius = 1e7;
    EXPECT_THROW(check(wide), std::invalid_argument);
  }
}

TEST(Motion, needs_a_length_in_the_papers_modes_only) {
  for (const QueryMode mode : kModes) {
    Motion ball = motion(mode);
    ball.previous = ball.tip = ball.trocar;
    if (is_paper_mode(mode)) {
      EXPECT_THROW(check(ball), std::invalid_argument);
    } else {
      EXPECT_NO_THROW(check(ball));
    }
  }
}

const std::string kHeader =
    "query,mode,trocar_x,trocar_y,trocar_z,previous_x,previous_y,previous_z,tip_x,tip_y,tip_z,"
    "radius\n";
const std::string kPoints = ",1,2,3,4,5,6,7,8,9";

std::vector<Motion> read_file(const std::string& file) {
  MotionReader reader(file);
  std::vector<Motion> motions;
  while (reader.is_ready()) {
    const std::optional<Motion> motion = reader.next();
    if (!motion) return motions;
    motions.push_back(*motion);
  }
  ADD_FAILURE() << "a file is always ready";
  return motions;
}

std::vector<Motion> read(const std::string& content) {
  return read_file(TemporaryFile(content).path());
}

/// The message for a file that is refused, without the file's name at its beginning.
std::string refusal(const std::string& content) {
  const TemporaryFile file(content);
  const std::string message = input_error([&] { read_file(file.path()); });
  EXPECT_EQ(message.find(file.path()), 0U) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  return message.substr(file.path().size());
}

TEST(MotionReader, reads_every_mode) {
  const std::pair<const char*, QueryMode> modes[] = {{"static", QueryMode::kStatic},
                                                     {"swept", QueryMode::kSwept},
                                                     {"paper_static", QueryMode::kPaperStatic},
                                                     {"paper_swept", QueryMode::kPaperSwept},
                                                     {"paper_naive", QueryMode::kPaperNaive}};
  for (const auto& [name, mode] : modes) {
    const std::vector<Motion> motions = read(kHeader + "7," + name + kPoints + ",0.005\n");
    ASSERT_EQ(motions.size(), 1U);
    EXPECT_EQ(motions[0].mode, mode);
    EXPECT_EQ(motions[0].query, "7");
    EXPECT_EQ(motions[0].line, 2U);
    EXPECT_EQ(motions[0].radius, 0.005);
  }
}

TEST(MotionReader, sweeps_from_the_previous_tip_about_a_resting_trocar) {
  const Motion motion = read("7,swept" + kPoints + ",0.005\n")[0];
  EXPECT_EQ(motion.trocar, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(motion.previous, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(motion.tip, Eigen::Vector3d(7, 8, 9));
}

TEST(MotionReader, ignores_the_previous_tip_in_static_modes) {
  for (const char* mode : {"static", "paper_static"}) {
    for (const char* previous : {",,,", ",x,nan,-", ",4,5,6"}) {
      const Motion motion =
          read(std::string("7,") + mode + ",1,2,3" + previous + ",7,8,9,0.005\n")[0];
      EXPECT_EQ(motion.trocar, Eigen::Vector3d(1, 2, 3));
      EXPECT_EQ(motion.previous, motion.tip);
      EXPECT_EQ(motion.tip, Eigen::Vector3d(7, 8, 9));
    }
  }
}

TEST(MotionReader, takes_windows_lines_blank_lines_and_blanks) {
  const std::vector<Motion> motions =
      read("\xEF\xBB\xBF\r\n" + kHeader + "\r\n 1 , static ,1,2, 3,,,,7,8,9, 1e-3 \r\n\r\n2,swept" +
           kPoints + ",1");
  ASSERT_EQ(motions.size(), 2U);
  EXPECT_EQ(motions[0].query, "1");
  EXPECT_EQ(motions[1].query, "2");
  EXPECT_EQ(motions[0].line, 4U);
  EXPECT_EQ(motions[0].radius, 1e-3);
  EXPECT_EQ(motions[1].line, 6U);
}

TEST(MotionReader, refuses_files_without_motions) {
  const std::string legal = ": the file ends without a motion; must have at least one";
  EXPECT_EQ(refusal(""), ":1" + legal);
  EXPECT_EQ(refusal(kHeader + "\n"), ":2" + legal);
}

TEST(MotionReader, refuses_other_columns) {
  EXPECT_EQ(refusal(kHeader + "1,swept" + kPoints + "\n"), ":2: 11 columns; must be 12");
  EXPECT_EQ(refusal(kHeader + "1,swept" + kPoints + ",1,\n"), ":2: 13 columns; must be 12");
  EXPECT_EQ(
      refusal("query,mode\n").find(":1: header is \"query,mode\"; must be query,mode,trocar_x,"),
      0U);
}

TEST(MotionReader, refuses_cells_naming_the_value_and_what_is_legal) {
  const std::string first = kHeader + "1,swept" + kPoints + ",1\n";
  EXPECT_EQ(refusal(first + ",swept" + kPoints + ",1\n"),
            ":3: query is empty; must be a number or a name");
  EXPECT_EQ(
      refusal(first + "2,sweep" + kPoints + ",1\n"),
      ":3: mode is \"sweep\"; legal are static, swept, paper_static, paper_swept and paper_naive");
  EXPECT_EQ(refusal(first + "2,swept,1,2,3,4,five,6,7,8,9,1\n"),
            ":3: previous_y is \"five\"; must be a number");
  EXPECT_EQ(refusal(first + "2,swept,1,2,,4,5,6,7,8,9,1\n"),
            ":3: trocar_z is \"\"; must be a number");
  EXPECT_EQ(refusal(first + "2,static,1,2,3,4,5,6,nan,8,9,1\n"),
            ":3: tip_x is \"nan\"; must be a finite number");
  EXPECT_EQ(refusal(first + "2,static,-inf,2,3,4,5,6,7,8,9,1\n"),
            ":3: trocar_x is \"-inf\"; must be a finite number");
  EXPECT_EQ(refusal(first + "2,static" + kPoints + ",0\n"), ":3: radius is \"0\"; must be above 0");
  EXPECT_EQ(refusal(first + "2,static" + kPoints + ",-1e-3\n"),
            ":3: radius is \"-1e-3\"; must be above 0");
  EXPECT_EQ(refusal(first + "2,static" + kPoints + ",inf\n"),
            ":3: radius is \"inf\"; must be a finite number");
}

TEST(MotionReader, refuses_motions_that_no_query_answers) {
  const std::string first = kHeader + "1,swept" + kPoints + ",1\n";
  EXPECT_EQ(refusal(first + "2,swept,1,2,3,4,5,6,7,8,1e7,1\n"),
            ":3: tip of waypoint 1 is (7, 8, 1e+07); must be finite and within 1e+06 m");
  const std::string too_short = refusal(first + "2,paper_swept,1,2,3,1,2,3,1,2,3,1\n");
  EXPECT_EQ(too_short.find(":3: "), 0U) << too_short;
}

TEST(MotionReader, gives_the_motions_before_an_illegal_line) {
  const TemporaryFile file("1,swept" + kPoints + ",1\n2,swept" + kPoints + ",1\n3\n");
  MotionReader reader(file.path());
  EXPECT_EQ(reader.name(), file.path());
  EXPECT_EQ(reader.next()->query, "1");
  EXPECT_EQ(reader.next()->query, "2");
  EXPECT_EQ(input_error([&] { reader.next(); }), file.path() + ":3: 1 columns; must be 12");
}

const std::string kPoints = ",1,2,3,4,5,6,7,8,9";
using Names = std::vector<std::string>;
using Order = MotionList::Order;

/// A file of motions with these queries.
std::string motions(const Names& queries) {
  std::string content;
  for (const std::string& query : queries) content += query + ",swept" + kPoints + ",1\n";
  return content;
}

/// The queries of a file in the order in which they are given.
Names given(const std::string& content, Order order) {
  const TemporaryFile file(content);
  MotionList list(file.path(), order);
  EXPECT_EQ(list.name(), file.path());
  Names queries;
  while (list.is_ready()) {
    const std::optional<Motion> motion = list.next();
    if (!motion) break;
    queries.push_back(motion->query);
  }
  EXPECT_EQ(list.size(), queries.size());
  return queries;
}

TEST(MotionList, sorts_integers_by_value_and_names_as_text) {
  const auto sorted = [](const Names& names) { return given(motions(names), Order::kByQuery); };
  EXPECT_EQ(sorted({"10", "9", "-3", "0", "100"}), (Names{"-3", "0", "9", "10", "100"}));
  EXPECT_EQ(sorted({"stab", "10", "9", "palpate 2"}), (Names{"10", "9", "palpate 2", "stab"}));
}

TEST(MotionList, keeps_the_order_of_the_file_if_asked_to) {
  for (const Names& names : {Names{"10", "9", "-3"}, Names{"stab", "10", "9"}}) {
    EXPECT_EQ(given(motions(names), Order::kAsInFile), names);
  }
}

TEST(MotionList, gives_a_motion_with_its_line) {
  const TemporaryFile file("\n7,swept" + kPoints + ",0.25\n\n6,static" + kPoints + ",0.5\n");
  MotionList list(file.path(), Order::kByQuery);
  const std::optional<Motion> first = list.next(), second = list.next();
  EXPECT_EQ(first->line, 4U);
  EXPECT_EQ(first->mode, QueryMode::kStatic);
  EXPECT_EQ(second->line, 2U);
  EXPECT_EQ(second->radius, 0.25);
  EXPECT_FALSE(list.next());
}

TEST(MotionList, refuses_a_query_that_comes_twice) {
  for (const Order order : {Order::kByQuery, Order::kAsInFile}) {
    const auto refusal = [&](const Names& names) {
      const TemporaryFile file(motions(names));
      return input_error([&] { MotionList(file.path(), order); }).substr(file.path().size());
    };
    EXPECT_EQ(refusal({"3", "4", "3"}),
              ":3: query \"3\" is already on line 1; each motion needs its own");
    EXPECT_EQ(refusal({"3", "03"}),
              ":2: query \"03\" is already on line 1; each motion needs its own");
    EXPECT_EQ(refusal({"a", "b", "b"}),
              ":3: query \"b\" is already on line 2; each motion needs its own");
  }
}

TEST(MotionList, refuses_illegal_files_as_a_whole) {
  const TemporaryFile file(motions({"1", "2"}) + "3,swept\n");
  EXPECT_EQ(input_error([&] { MotionList(file.path(), Order::kByQuery); }),
            file.path() + ":3: 2 columns; must be 12");
  EXPECT_EQ(input_error([&] { MotionList("/nowhere/m.csv", Order::kByQuery); }),
            "/nowhere/m.csv: cannot be opened: No such file or directory");
}

}  // namespace

}  // namespace organ_collision
