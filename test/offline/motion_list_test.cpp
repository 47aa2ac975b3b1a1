#include "offline/motion_list.hpp"

#include <gtest/gtest.h>

#include "temporary_file.hpp"

namespace organ_collision {
namespace {

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
