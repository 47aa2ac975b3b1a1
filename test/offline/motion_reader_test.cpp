#include "offline/motion_reader.hpp"

#include <gtest/gtest.h>

#include "temporary_file.hpp"

namespace organ_collision {
namespace {

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

}  // namespace
}  // namespace organ_collision
