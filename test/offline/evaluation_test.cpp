#include "offline/evaluation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

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

Printed evaluate(ListedMotions motions, LimitedShapes& shapes, std::size_t jobs,
                 const Options& options = {}) {
  QueryWorkers threads(jobs, PickerKind::kFeedback);
  Printed printed;
  Evaluation evaluation(options, motions, shapes, threads);
  try {
    evaluation.run([&](const std::string& csv, std::size_t count) {
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
  const Printed right = evaluate(ListedMotions(1000), shapes, 1);
  EXPECT_EQ(right.error, "");
  EXPECT_EQ(right.motions, 1000U);
  EXPECT_EQ(queries(right.csv), touching(1000));
  for (const std::size_t jobs : {2U, 3U, 7U}) {
    LimitedShapes shapes_again(1000);
    EXPECT_EQ(evaluate(ListedMotions(1000), shapes_again, jobs).csv, right.csv);
  }
}

TEST(Evaluation, takes_only_motions_that_are_ready_and_no_more_than_the_most) {
  LimitedShapes shapes(250);
  evaluate(ListedMotions(250), shapes, 2);
  EXPECT_EQ(shapes.rounds, (std::vector<std::size_t>{80, 19, 80, 20, 51}));
}

TEST(Evaluation, answers_the_motions_before_an_illegal_one) {
  for (const std::size_t jobs : {1U, 3U}) {
    for (const std::size_t illegal : {0U, 1U, 57U, 120U}) {
      LimitedShapes shapes(1000);
      ListedMotions motions(1000);
      motions.illegal = illegal;
      const Printed printed = evaluate(motions, shapes, jobs);
      EXPECT_EQ(printed.error, "list:" + std::to_string(illegal + 1) + ": it is illegal");
      EXPECT_EQ(queries(printed.csv), touching(illegal));
    }
  }
}

TEST(Evaluation, answers_the_motions_that_have_shapes) {
  LimitedShapes few(130);
  const Printed printed = evaluate(ListedMotions(200), few, 2);
  EXPECT_EQ(printed.error, "list:131: there is no shape for this motion; must have as many shapes");
  EXPECT_EQ(queries(printed.csv), touching(130));

  LimitedShapes broken(130);
  broken.error_at_end = std::make_exception_ptr(InputError("131.obj", 4, "it is illegal"));
  EXPECT_EQ(evaluate(ListedMotions(200), broken, 2).error, "131.obj:4: it is illegal");

  LimitedShapes many(130);
  EXPECT_EQ(evaluate(ListedMotions(100), many, 2).error,
            "list: the motions end; shapes without a motion: 30; each shape needs one");
}

TEST(Evaluation, puts_a_blank_line_behind_each_answer_if_asked_to) {
  Options options;
  options.blank_lines = true;
  LimitedShapes shapes(4);
  const std::vector<std::string> right{"", "2", "", "3", "", ""};
  EXPECT_EQ(queries(evaluate(ListedMotions(4), shapes, 2, options).csv), right);
}

TEST(Evaluation, adds_the_columns_that_are_asked_for) {
  Options options;
  options.placement = true;
  options.margin = 0.5;
  LimitedShapes shapes(3);
  const Printed printed = evaluate(ListedMotions(3), shapes, 1, options);
  EXPECT_EQ(printed.csv.find(contacts_header({true, true})), 0U);
  EXPECT_NE(printed.csv.find("\n1,,,,,,,,,,beyond_margin,"), std::string::npos);
  EXPECT_NE(printed.csv.find("\n2,0,"), std::string::npos);
}

}  // namespace
}  // namespace organ_collision
