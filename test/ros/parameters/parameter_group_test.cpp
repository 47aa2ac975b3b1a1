#include "ros/parameters/parameter_group.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace organ_collision {
namespace {

using XmlRpc::XmlRpcValue;

const NumberRange kOneToTen{1.0, 10.0};

/// The group "~g" with the member "x". A member "y" is legal too.
ParameterGroup group_of(const XmlRpcValue& x) {
  XmlRpcValue members;
  members["x"] = x;
  return {"~g", members, {"x", "y"}};
}

XmlRpcValue list_of(const XmlRpcValue& first, const XmlRpcValue& second) {
  XmlRpcValue list;
  list[0] = first;
  list[1] = second;
  return list;
}

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const ParameterError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ParameterGroup, TakesLegalValuesAndDefaults) {
  EXPECT_EQ(group_of(2.5).number("x", {}, kPositive), 2.5);
  EXPECT_EQ(group_of(2).number("x", {}, kPositive), 2.0);
  EXPECT_EQ(group_of(kUnlimited).number("x", {}, kPositiveOrInfinite), kUnlimited);
  EXPECT_EQ(group_of(1).whole_number("x", 5, kOneToTen), 1);
  EXPECT_EQ(group_of(10).whole_number("x", 5, kOneToTen), 10);
  EXPECT_TRUE(group_of(true).flag("x", false));
  EXPECT_EQ(group_of("text").text("x"), "text");
  EXPECT_EQ(group_of("/a/b").frame("x"), "a/b");
  EXPECT_EQ(group_of("b").choice("x", "a", {"a", "b"}), "b");
  EXPECT_EQ(group_of(list_of("b", "a")).texts("x"), (std::vector<std::string>{"b", "a"}));
  EXPECT_EQ(group_of(1).number("y", 0.5, kPositive), 0.5);
  EXPECT_EQ(group_of(1).whole_number("y", 7, kOneToTen), 7);
  EXPECT_FALSE(group_of(1).flag("y", false));
  EXPECT_EQ(group_of(1).choice("y", "a", {"a", "b"}), "a");
}

/// How a value is read, and the refusal.
struct Refusal {
  XmlRpcValue value;
  std::function<void(const ParameterGroup&)> read;
  std::string message;
};

TEST(ParameterGroup, RefusesNamingParameterValueAndWhatIsLegal) {
  const auto number = [](const auto& group) { group.number("x", {}, kPositive); };
  const auto whole = [](const auto& group) { group.whole_number("x", 5, kOneToTen); };
  const auto flag = [](const auto& group) { group.flag("x", true); };
  const auto text = [](const auto& group) { group.text("x"); };
  const auto choice = [](const auto& group) { group.choice("x", "a", {"a", "b"}); };
  const auto list = [](const auto& group) { group.list("x", "tools"); };
  const auto texts = [](const auto& group) { group.texts("x"); };
  const std::string a_number = "; must be a number, more than 0";
  const std::string a_whole = "; must be a whole number, at least 1, at most 10";
  const std::string a_list = "; must be a list, not empty, of texts that are not empty, each once";
  XmlRpcValue empty;
  empty.setSize(0);
  const std::vector<Refusal> refusals = {
      {0.0, number, "'0'" + a_number},
      {-1e-9, number, "'-1e-09'" + a_number},
      {std::nan(""), number, "'nan'" + a_number},
      {kUnlimited, number, "'inf'" + a_number},
      {"2.5", number, "'2.5'" + a_number},
      {true, number, "'1'" + a_number},
      {11, whole, "'11'" + a_whole},
      {2.0, whole, "'2'" + a_whole},
      {"yes", flag, "'yes'; must be true or false"},
      {1, flag, "'1'; must be true or false"},
      {1, text, "'1'; must be a text that is not empty"},
      {"", text, "''; must be a text that is not empty"},
      {"c", choice, "'c'; must be one of a, b"},
      {1, choice, "'1'; must be one of a, b"},
      {"text", list, "'text'; must be a list of tools"},
      {"text", texts, "'text'" + a_list},
      {empty, texts, "'{}'" + a_list},
      {list_of("a", 1), texts, "'{a,1}'" + a_list},
      {list_of("a", ""), texts, "'{a,}'" + a_list},
      {list_of("a", "a"), texts, "'{a,a}'" + a_list},
  };
  for (const Refusal& row : refusals) {
    EXPECT_EQ(message_of([&] { row.read(group_of(row.value)); }), "~g/x is " + row.message);
  }
  EXPECT_EQ(message_of([] { group_of(1).texts("y"); }), "~g/y is missing" + a_list);
  EXPECT_EQ(message_of([] { ParameterGroup("~tools[1]", XmlRpcValue("hook"), {"name"}); }),
            "~tools[1] is 'hook'; must be a group of name");
}

TEST(ParameterGroup, MissingOnesNameWhatMayHaveBeenMeant) {
  XmlRpcValue members;
  members["raduis"] = 0.005;
  const ParameterGroup group("~tools[0]", members, {"name", "radius"});
  EXPECT_EQ(message_of([&] { group.number("radius", {}, kPositive); }),
            "~tools[0]/radius is missing; must be a number, more than 0 (~tools[0]/raduis is no "
            "parameter; nearest is 'radius', legal are name, radius)");
}

}  // namespace
}  // namespace organ_collision
