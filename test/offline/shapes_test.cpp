#include "offline/shapes.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <string>
#include <vector>

#include "temporary_files.hpp"

namespace organ_collision {
namespace {

TEST(QueryWorkers, do_tasks_with_a_query_for_each_worker) {
  const TriangleMesh organ({-1.0F, -1.0F, 0.0F, 1.0F, -1.0F, 0.0F, 0.0F, 1.0F, 0.0F}, {0, 1, 2});
  for (const std::size_t count : {1U, 2U, 5U}) {
    QueryWorkers threads(count, PickerKind::kFeedback);
    EXPECT_EQ(threads.count(), count);
    for (const std::size_t tasks : {0U, 1U, 3U, 40U}) {
      std::vector<CollisionResult> results(tasks);
      std::vector<std::size_t> delivered;
      threads.run(
          tasks,
          [&](std::size_t worker, std::size_t task) {
            ASSERT_LT(worker, count);
            CollisionRequest request;
            request.organ = &organ;
            request.radius = 0.01;
            const double x = task % 2 == 0 ? 0.0 : 2.0;
            request.path = {{1.0, {{x, 0.0, 1.0}, {x, 0.0, 0.0}}}};
            threads.query(worker).evaluate(request, results[task]);
          },
          [&](std::size_t task) { delivered.push_back(task); });
      std::vector<std::size_t> all(tasks);
      std::iota(all.begin(), all.end(), std::size_t{0});
      EXPECT_EQ(delivered, all);
      for (std::size_t task = 0; task < tasks; ++task) {
        EXPECT_EQ(results[task].contacts.size(), task % 2 == 0 ? 1U : 0U);
      }
    }
  }
}

void expect_order(const std::vector<std::string>& names) {
  for (std::size_t a = 0; a < names.size(); ++a) {
    for (std::size_t b = 0; b < names.size(); ++b) {
      EXPECT_EQ(is_naturally_before(names[a], names[b]), a < b) << names[a] << ", " << names[b];
    }
  }
}

TEST(NaturalOrder, takes_numbers_by_value_and_all_else_as_text) {
  expect_order({"step_2.obj", "step_10.obj", "step_100.obj"});
  expect_order({"a", "a0", "a1", "a1b", "a01c", "a2", "a10", "b"});
  expect_order({"run1_9", "run1_10", "run2_1", "run10_1"});
  expect_order({"", "-", "1", "A", "a", "\xC3\xA9"});
}

TEST(NaturalOrder, takes_numbers_of_any_length) {
  expect_order({"99999999999999999999998", "99999999999999999999999", "100000000000000000000000"});
}

TEST(NaturalOrder, orders_equal_numbers_as_text) {
  expect_order({"0.obj", "00.obj", "01.obj", "1.obj", "2.obj", "10.obj"});
}

using Paths = std::vector<std::string>;

TEST(ShapeFolder, has_the_obj_files_in_natural_order) {
  const TemporaryFolder folder;
  const std::string ten = folder.write("step_10.obj", ""), two = folder.write("step_2.obj", ""),
                    one = folder.write("step_01.OBJ", "");
  EXPECT_EQ(shape_files(folder.path()), (Paths{one, two, ten}));
}

TEST(ShapeFolder, leaves_out_other_files) {
  const TemporaryFolder folder;
  for (const char* name : {"motions.csv", "obj", ".obj", ".step_1.obj", "step_1.obj~", "a.mtl"}) {
    folder.write(name, "");
  }
  const std::string shape = folder.write("a.b.obj", "");
  EXPECT_EQ(shape_files(folder.path()), Paths{shape});
}

TEST(ShapeFolder, refuses_what_has_no_shapes) {
  const TemporaryFolder folder;
  EXPECT_EQ(input_error([&] { shape_files(folder.path()); }),
            folder.path() + ": the folder has no OBJ file; must have at least one");
  EXPECT_EQ(input_error([] { shape_files("/nowhere"); }),
            "/nowhere: cannot be read: No such file or directory");
  const std::string file = folder.write("a.obj", "");
  EXPECT_EQ(input_error([&] { shape_files(file); }), file + ": cannot be read: Not a directory");
}

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
