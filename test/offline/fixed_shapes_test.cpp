#include "offline/fixed_shapes.hpp"

#include <gtest/gtest.h>

#include "temporary_file.hpp"
#include "temporary_folder.hpp"

namespace organ_collision {
namespace {

const std::string kVertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\n", kMoved = "v 0 0 2\nv 1 0 2\nv 1 1 2\n";

std::exception_ptr get(FixedShapes& shapes, std::size_t count) {
  QueryWorkers threads(1, PickerKind::kFeedback);
  std::exception_ptr error;
  EXPECT_EQ(shapes.get(count, threads, error), count);
  return error;
}

TEST(FixedShapes, are_the_same_for_all_motions) {
  const TemporaryFolder folder;
  FixedShapes shapes(folder.write("now.obj", kVertices + "f 1 2 3\n"),
                     folder.write("before.obj", kMoved + "f 1 2 3\n"));
  for (int round = 0; round < 2; ++round) {
    EXPECT_FALSE(get(shapes, 5));
    EXPECT_EQ(shapes.remaining(), 0U);
    for (const std::size_t motion : {0U, 4U}) {
      const OrganShapes organ = shapes.shapes_of(motion);
      EXPECT_EQ(organ.now, &shapes.first());
      EXPECT_EQ(organ.now->vertex(0), Eigen::Vector3d(0, 0, 0));
      ASSERT_TRUE(organ.before);
      EXPECT_EQ(organ.before->vertex(0), Eigen::Vector3d(0, 0, 2));
      EXPECT_TRUE(organ.before->same_faces(*organ.now));
    }
  }
}

TEST(FixedShapes, rest_without_an_earlier_shape) {
  const TemporaryFolder folder;
  FixedShapes shapes(folder.write("now.obj", kVertices + "f 1 2 3\n"), "");
  EXPECT_FALSE(get(shapes, 1));
  EXPECT_FALSE(shapes.shapes_of(0).before);
}

TEST(FixedShapes, need_the_same_faces) {
  const TemporaryFolder folder;
  const std::string now = folder.write("now.obj", kVertices + "f 1 2 3\n");
  const std::string before = folder.write("before.obj", kMoved + "f 1 3 2\n");
  EXPECT_EQ(input_error([&] { FixedShapes(now, before); }),
            before + ":4: face 0 has the vertices 1 3 2; in " + now + " they are 1 2 3");
}

}  // namespace
}  // namespace organ_collision
