#include "offline/shape_sequence.hpp"

#include <gtest/gtest.h>

#include "temporary_file.hpp"
#include "temporary_folder.hpp"

namespace organ_collision {
namespace {

std::string obj_at(std::size_t height, const std::string& faces = "f 1 2 3\n") {
  const std::string z = ' ' + std::to_string(height) + '\n';
  return "v 0 0" + z + "v 1 0" + z + "v 1 1" + z + faces;
}

/// Files of a plate that rises by 1 m in each step.
std::vector<std::string> rising_plate(const TemporaryFolder& folder, std::size_t steps) {
  std::vector<std::string> files;
  for (std::size_t i = 0; i < steps; ++i) {
    files.push_back(folder.write(std::to_string(i) + ".obj", obj_at(i)));
  }
  return files;
}

double height(const TriangleMesh* shape) { return shape->vertex(2).z(); }

TEST(ShapeSequence, goes_from_shape_to_shape_in_rounds_of_any_size) {
  const TemporaryFolder folder;
  const std::vector<std::string> files = rising_plate(folder, 12);
  for (const std::size_t jobs : {1U, 3U}) {
    QueryWorkers threads(jobs, PickerKind::kFeedback);
    ShapeSequence shapes(files);
    EXPECT_EQ(shapes.remaining(), 12U);
    EXPECT_EQ(height(&shapes.first()), 0.0);
    std::size_t step = 0;
    for (const std::size_t count : {1U, 3U, 5U, 2U, 1U}) {
      std::exception_ptr error;
      ASSERT_EQ(shapes.get(count, threads, error), count);
      EXPECT_FALSE(error);
      for (std::size_t motion = 0; motion < count; ++motion, ++step) {
        const OrganShapes organ = shapes.shapes_of(motion);
        EXPECT_EQ(height(organ.now), double(step));
        EXPECT_TRUE(organ.now->same_faces(shapes.first()));
        ASSERT_EQ(organ.before == nullptr, step == 0);
        EXPECT_EQ(organ.before ? height(organ.before) : -1.0, double(step) - 1.0);
      }
      EXPECT_EQ(shapes.remaining(), 12U - step);
    }
    std::exception_ptr error;
    EXPECT_EQ(shapes.get(3, threads, error), 0U);
    EXPECT_FALSE(error);
  }
}

TEST(ShapeSequence, gives_the_shapes_before_the_end) {
  const TemporaryFolder folder;
  QueryWorkers threads(2, PickerKind::kFeedback);
  ShapeSequence shapes(rising_plate(folder, 3));
  std::exception_ptr error;
  EXPECT_EQ(shapes.get(5, threads, error), 3U);
  EXPECT_FALSE(error);
  EXPECT_EQ(height(shapes.shapes_of(2).now), 2.0);
}

TEST(ShapeSequence, gives_the_shapes_before_an_illegal_one) {
  const TemporaryFolder folder;
  for (const auto& [content, message] : std::vector<std::pair<std::string, std::string>>{
           {obj_at(2, "f 1 3 2\n"), ":4: face 0 has the vertices 1 3 2; in "},
           {obj_at(2, "f 1 2 3\nf 1 2 3\n"), ":5: the file ends with 3 vertices and 2 faces; "},
           {"v 0 0 nan\n", ":1: z is \"nan\""}}) {
    std::vector<std::string> files = rising_plate(folder, 5);
    folder.write("2.obj", content);
    for (const std::size_t jobs : {1U, 3U}) {
      QueryWorkers threads(jobs, PickerKind::kFeedback);
      ShapeSequence shapes(files);
      std::exception_ptr error;
      ASSERT_EQ(shapes.get(4, threads, error), 2U);
      EXPECT_EQ(height(shapes.shapes_of(1).now), 1.0);
      ASSERT_TRUE(error);
      const std::string said = input_error([&] { std::rethrow_exception(error); });
      EXPECT_EQ(said.find(files[2] + message), 0U) << said;
    }
  }
}

TEST(ShapeSequence, refuses_an_illegal_first_shape_at_once) {
  const TemporaryFolder folder;
  const std::string file = folder.write("0.obj", "v 0 0 0\n");
  EXPECT_EQ(input_error([&] { ShapeSequence({file}); }).find(file + ":1: "), 0U);
}

}  // namespace
}  // namespace organ_collision
