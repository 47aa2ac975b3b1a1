#include "offline/motion.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

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

}  // namespace
}  // namespace organ_collision
