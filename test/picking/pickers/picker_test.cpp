#include "picking/pickers/picker.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <utility>
#include <vector>

#include "picker_fixture.hpp"
#include "picking/volumes/paper_volumes.hpp"
#include "test/picking/volumes/random_motions.hpp"
#include "test/resident_memory.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

INSTANTIATE_TEST_SUITE_P(Kinds, PickerTest,
                         testing::Values(PickerKind::kFeedback, PickerKind::kSelect,
                                         PickerKind::kCpu),
                         picker_name);

// A box of 2 m by 2 m by 2 m whose center is not the frame's origin.
ViewingVolume box() {
  return ViewingVolume::orthographic(
      {Vector3d(3, -2, 5), Vector3d::Zero(), Eigen::Matrix3d::Identity(), -1, 1, -1, 1, -1, 1});
}

Triangle moved(const Triangle& face, const Vector3d& by) {
  return {face[0] + by, face[1] + by, face[2] + by};
}

TEST_P(PickerTest, PicksDegenerateAndEdgeOnFacesThatTouch) {
  const Vector3d origin = box().origin();
  const Vector3d inside(0.25, -0.5, 0.125), far_left(-4, -0.5, 0.125), far_right(4, -0.5, 0.125);
  const Vector3d above(0.25, 3, 0.125), behind(0.25, -0.5, 7);
  const std::vector<std::pair<Triangle, bool>> faces = {
      {{inside, inside, inside}, true},         // a point
      {{far_left, far_left, far_left}, false},  //
      {{far_left, far_right, far_left}, true},  // a segment through the box
      {{far_left, far_left, far_right}, true},  //
      {{far_left, far_right, inside}, true},    // three corners on a line
      {{above, far_right, far_right}, false},   // a segment that passes by
      {{inside, behind, inside}, true},         // a segment along the view
      {{inside, behind, above}, true},          // a face edge-on to the view
      {{far_left, far_right, behind}, true},    //
      {{Vector3d(-1, -3, 0), Vector3d(-1, 3, 0), Vector3d(-5, 0, 0)}, true},  // touches a side
      {{Vector3d(1, 1, 1), Vector3d(5, 1, 1), Vector3d(1, 5, 3)}, true},      // touches a corner
  };
  Soup soup;
  std::vector<std::uint32_t> expected;
  for (const auto& [face, touches] : faces) {
    // Every order of the corners.
    for (const auto& order : {std::array{0, 1, 2}, std::array{2, 1, 0}, std::array{1, 2, 0},
                              std::array{0, 2, 1}, std::array{1, 0, 2}, std::array{2, 0, 1}}) {
      if (touches) expected.push_back(static_cast<std::uint32_t>(soup.size()));
      soup.add(
          moved({face[static_cast<std::size_t>(order[0])], face[static_cast<std::size_t>(order[1])],
                 face[static_cast<std::size_t>(order[2])]},
                origin));
    }
  }
  EXPECT_EQ(numbers(pick(box(), soup.mesh())), expected);
}

TEST_P(PickerTest, GrowsItsBufferUntilAllHitsFit) {
  Random random(27);
  Soup soup;
  for (int i = 0; i < 70'000; ++i) {
    const Vector3d centre = box().origin() + 0.5 * random.direction();
    soup.add({centre, centre + 0.1 * random.direction(), centre + 2 * random.direction()});
  }
  const TriangleMesh mesh = soup.mesh();
  const std::vector<Candidate> candidates = pick(box(), mesh);
  ASSERT_EQ(candidates.size(), soup.size());
  for (std::uint32_t i = 0; i < candidates.size(); ++i) ASSERT_EQ(candidates[i].face, i);
}

TEST_P(PickerTest, FindsNothingWhereNothingIs) {
  Soup soup;
  soup.add(moved({Vector3d(2, 0, 0), Vector3d(2, 1, 0), Vector3d(2, 0, 1)}, box().origin()));
  EXPECT_TRUE(pick(box(), soup.mesh()).empty());
}

TEST_P(PickerTest, AnswersDoNotDependOnEarlierQueries) {
  Random random(28);
  const std::unique_ptr<Picker> other =
      make_picker(GetParam() == PickerKind::kSelect ? PickerKind::kFeedback : PickerKind::kSelect);
  std::vector<Candidate> ignored;
  const ShaftMotion motion = random_motion(MotionKind::kSideways, 0.3, random);
  Soup soup;
  for (int k = 0; k < 200; ++k) {
    const Vector3d centre = motion.at(random.uniform(0, 1)).at(random.uniform(0, 1.1));
    soup.add({centre, centre + 0.02 * random.direction(), centre + 0.02 * random.direction()});
  }
  const TriangleMesh mesh = soup.mesh();
  const ViewingVolume plain = paper_static_volume(motion.end, 0.004);
  const ViewingVolume planes = paper_swept_volume(motion, 0.004);
  const std::vector<std::uint32_t> expected_plain = numbers(pick(plain, mesh));
  const std::vector<std::uint32_t> expected_planes = numbers(pick(planes, mesh));
  EXPECT_NE(expected_plain, expected_planes);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(numbers(pick(planes, mesh)), expected_planes);
    other->pick(planes, mesh, ignored);
    EXPECT_EQ(numbers(pick(plain, mesh)), expected_plain);
    other->pick(plain, mesh, ignored);
  }
}

// If faces were drawn by glBegin in GL_SELECT mode, Mesa would lose a buffer of 512 KB after every
// 2200 such queries.
TEST_P(PickerTest, TakesNoMemoryForEachQuery) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "memory that is freed stays with the sanitizer";
#endif
  Soup soup;
  for (int i = 0; i < 5; ++i) {
    soup.add(
        moved({Vector3d(-4, 0, 0.1 * i), Vector3d(4, 0, 0), Vector3d(0, 4, 0)}, box().origin()));
  }
  const TriangleMesh mesh = soup.mesh();
  std::vector<Candidate> candidates;
  long before = 0;
  for (int i = 0; i < 24'000; ++i) {
    if (i == 4000) before = resident_memory();
    picker_->pick(box(), mesh, candidates);
    ASSERT_EQ(candidates.size(), soup.size());
  }
  EXPECT_LT(resident_memory() - before, 2'000'000);
}

TEST(Picker, WithoutOpenGlSaysSo) {
  const std::unique_ptr<Picker> picker = make_picker(PickerKind::kCpu);
  EXPECT_EQ(picker->gl_version(), "none (picker: cpu)");
}

}  // namespace
}  // namespace organ_collision
