#include "offline/evaluation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "offline/contacts_csv.hpp"
#include "temporary_files.hpp"

namespace organ_collision {
namespace {

/// Motions in the order of a list. Some of them are not ready before they are waited for; one of
/// them may be illegal.
class ListedMotions : public MotionSource {
 public:
  explicit ListedMotions(std::size_t count) : count_(count) {}

  std::optional<Motion> next() override {
    if (next_ == illegal) throw InputError(name_, next_ + 1, "it is illegal");
    if (next_ == count_) return std::nullopt;
    const double x = next_ % 3 == 0 ? 2.0 : 0.005 * double(next_ % 50);
    ++next_;
    return Motion{std::to_string(next_), next_, QueryMode::kSwept, {x, 0.1, 1.0}, {x, 0.1, 0.5},
                  {x, 0.1, 0.0},         0.01};
  }
  bool is_ready() override { return next_ % 100 != 99; }
  const std::string& name() const override { return name_; }

  std::size_t illegal = 1'000'000;

 private:
  std::string name_ = "list";
  std::size_t count_, next_ = 0;
};

/// A face at rest, for a limited number of motions.
class LimitedShapes : public ShapeSource {
 public:
  explicit LimitedShapes(std::size_t count) : remaining_(count) {}

  std::size_t most_for_each_thread() const override { return 40; }
  std::size_t get(std::size_t count, QueryWorkers&, std::exception_ptr& error) override {
    rounds.push_back(count);
    const std::size_t got = std::min(count, remaining_);
    remaining_ -= got;
    if (got < count) error = error_at_end;
    return got;
  }
  OrganShapes shapes_of(std::size_t) const override { return {&organ_, nullptr}; }
  std::size_t remaining() const override { return remaining_; }
  const TriangleMesh& first() const override { return organ_; }

  std::vector<std::size_t> rounds;  ///< the sizes that were asked for
  std::exception_ptr error_at_end;

 private:
  TriangleMesh organ_{{-1.0F, -1.0F, 0.0F, 1.0F, -1.0F, 0.0F, 0.0F, 1.0F, 0.0F}, {0, 1, 2}};
  std::size_t remaining_;
};

struct Printed {
  std::string csv;
  std::size_t motions = 0;
  std::string error;
};

Printed printed_for(ListedMotions motions, LimitedShapes& shapes, std::size_t jobs,
                    Questions questions = {}) {
  questions.jobs = jobs;
  Printed printed;
  try {
    evaluate(questions, motions, shapes, [&](const std::string& csv, std::size_t count) {
      printed.csv += csv;
      printed.motions += count;
    });
  } catch (const InputError& error) {
    printed.error = error.what();
  }
  return printed;
}

/// The queries of the lines, without the header.
std::vector<std::string> queries(const std::string& csv) {
  std::vector<std::string> found;
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line + '\n', contacts_header());
  while (std::getline(lines, line)) found.push_back(line.substr(0, line.find(',')));
  return found;
}

std::vector<std::string> touching(std::size_t count) {
  std::vector<std::string> right;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 3 != 0) right.push_back(std::to_string(i + 1));
  }
  return right;
}

TEST(Evaluation, prints_the_same_answers_in_order_for_any_number_of_threads) {
  LimitedShapes shapes(1000);
  const Printed right = printed_for(ListedMotions(1000), shapes, 1);
  EXPECT_EQ(right.error, "");
  EXPECT_EQ(right.motions, 1000U);
  EXPECT_EQ(queries(right.csv), touching(1000));
  for (const std::size_t jobs : {2U, 3U, 7U}) {
    LimitedShapes shapes_again(1000);
    EXPECT_EQ(printed_for(ListedMotions(1000), shapes_again, jobs).csv, right.csv);
  }
}

TEST(Evaluation, takes_only_motions_that_are_ready_and_no_more_than_the_most) {
  LimitedShapes shapes(250);
  printed_for(ListedMotions(250), shapes, 2);
  EXPECT_EQ(shapes.rounds, (std::vector<std::size_t>{80, 19, 80, 20, 51}));
}

TEST(Evaluation, answers_the_motions_before_an_illegal_one) {
  for (const std::size_t jobs : {1U, 3U}) {
    for (const std::size_t illegal : {0U, 1U, 57U, 120U}) {
      LimitedShapes shapes(1000);
      ListedMotions motions(1000);
      motions.illegal = illegal;
      const Printed printed = printed_for(motions, shapes, jobs);
      EXPECT_EQ(printed.error, "list:" + std::to_string(illegal + 1) + ": it is illegal");
      EXPECT_EQ(queries(printed.csv), touching(illegal));
    }
  }
}

TEST(Evaluation, answers_the_motions_that_have_shapes) {
  LimitedShapes few(130);
  const Printed printed = printed_for(ListedMotions(200), few, 2);
  EXPECT_EQ(printed.error, "list:131: there is no shape for this motion; must have as many shapes");
  EXPECT_EQ(queries(printed.csv), touching(130));

  LimitedShapes broken(130);
  broken.error_at_end = std::make_exception_ptr(InputError("131.obj", 4, "it is illegal"));
  EXPECT_EQ(printed_for(ListedMotions(200), broken, 2).error, "131.obj:4: it is illegal");

  LimitedShapes many(130);
  EXPECT_EQ(printed_for(ListedMotions(100), many, 2).error,
            "list: the motions end; shapes without a motion: 30; each shape needs one");
}

const std::string kFace = "f 1 2 3\n";

/// A plate at this height [m].
std::string plate(std::size_t height, const std::string& faces = kFace) {
  const std::string z = ' ' + std::to_string(height) + '\n';
  return "v 0 0" + z + "v 1 0" + z + "v 1 1" + z + faces;
}

double height(const TriangleMesh* shape) { return shape->vertex(2).z(); }

TEST(FixedShapes, are_the_same_for_all_motions) {
  const TemporaryFolder folder;
  const std::string now = folder.write("now.obj", plate(0)),
                    before = folder.write("before.obj", plate(2));
  QueryWorkers threads(1, {});
  const auto moving = fixed_shapes(now, before), resting = fixed_shapes(now, "");
  for (int round = 0; round < 2; ++round) {
    std::exception_ptr error;
    EXPECT_EQ(moving->get(5, threads, error), 5U);
    EXPECT_FALSE(error);
    EXPECT_EQ(moving->remaining(), 0U);
    for (const std::size_t motion : {0U, 4U}) {
      const OrganShapes organ = moving->shapes_of(motion);
      EXPECT_EQ(organ.now, &moving->first());
      EXPECT_EQ(height(organ.now), 0.0);
      ASSERT_TRUE(organ.before);
      EXPECT_EQ(height(organ.before), 2.0);
      EXPECT_TRUE(organ.before->same_faces(*organ.now));
    }
  }
  EXPECT_FALSE(resting->shapes_of(0).before);
  folder.write("before.obj", plate(2, "f 1 3 2\n"));
  EXPECT_EQ(input_error([&] { fixed_shapes(now, before); }),
            before + ":4: face 0 has the vertices 1 3 2; in " + now + " they are 1 2 3");
}

/// Files of a plate that rises by 1 m in each step, among others.
std::vector<std::string> rising_plate(const TemporaryFolder& folder, std::size_t steps) {
  for (const char* name : {"motions.csv", "obj", ".obj", ".step_1.obj", "step_1.obj~", "a.mtl"}) {
    folder.write(name, "");
  }
  std::vector<std::string> files;
  for (std::size_t i = 0; i < steps; ++i) {
    const std::string ending = i % 2 == 0 ? ".obj" : ".OBJ";
    files.push_back(folder.write("step_" + std::to_string(i) + ending, plate(i)));
  }
  return files;
}

TEST(RecordedShapes, go_from_shape_to_shape_in_rounds_of_any_size) {
  const TemporaryFolder folder;
  rising_plate(folder, 12);
  for (const std::size_t jobs : {1U, 3U}) {
    QueryWorkers threads(jobs, {});
    const auto shapes = recorded_shapes(folder.path());
    EXPECT_EQ(shapes->remaining(), 12U);
    EXPECT_EQ(height(&shapes->first()), 0.0);
    std::size_t step = 0;
    for (const std::size_t count : {1U, 3U, 5U, 2U, 1U}) {
      std::exception_ptr error;
      ASSERT_EQ(shapes->get(count, threads, error), count);
      EXPECT_FALSE(error);
      for (std::size_t motion = 0; motion < count; ++motion, ++step) {
        const OrganShapes organ = shapes->shapes_of(motion);
        EXPECT_EQ(height(organ.now), double(step));
        EXPECT_TRUE(organ.now->same_faces(shapes->first()));
        ASSERT_EQ(organ.before == nullptr, step == 0);
        EXPECT_EQ(organ.before ? height(organ.before) : -1.0, double(step) - 1.0);
      }
      EXPECT_EQ(shapes->remaining(), 12U - step);
    }
    std::exception_ptr error;
    EXPECT_EQ(shapes->get(3, threads, error), 0U);
    EXPECT_FALSE(error);
  }
}

TEST(RecordedShapes, give_the_shapes_before_an_illegal_one) {
  for (const auto& [content, message] : std::vector<std::pair<std::string, std::string>>{
           {plate(2, "f 1 3 2\n"), ":4: face 0 has the vertices 1 3 2; in "},
           {plate(2, kFace + kFace), ":5: the file ends with 3 vertices and 2 faces; "},
           {"v 0 0 nan\n", ":1: z is \"nan\""}}) {
    const TemporaryFolder folder;
    const std::vector<std::string> files = rising_plate(folder, 5);
    folder.write("step_2.obj", content);
    QueryWorkers threads(3, {});
    const auto shapes = recorded_shapes(folder.path());
    std::exception_ptr error;
    ASSERT_EQ(shapes->get(4, threads, error), 2U);
    EXPECT_EQ(height(shapes->shapes_of(1).now), 1.0);
    ASSERT_TRUE(error);
    const std::string said = input_error([&, error = error] { std::rethrow_exception(error); });
    EXPECT_EQ(said.find(files[2] + message), 0U) << said;
  }
}

TEST(RecordedShapes, need_a_folder_with_a_legal_first_shape) {
  const TemporaryFolder folder;
  EXPECT_EQ(input_error([&] { recorded_shapes(folder.path()); }),
            folder.path() + ": the folder has no OBJ file; must have at least one");
  EXPECT_EQ(input_error([] { recorded_shapes("/nowhere"); }),
            "/nowhere: cannot be read: No such file or directory");
  const std::string file = folder.write("0.obj", "v 0 0 0\n");
  EXPECT_EQ(input_error([&] { recorded_shapes(file); }),
            file + ": cannot be read: Not a directory");
  EXPECT_EQ(input_error([&] { recorded_shapes(folder.path()); }).find(file + ":1: "), 0U);
}

}  // namespace
}  // namespace organ_collision
