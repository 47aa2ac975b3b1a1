#include "ros/parameters/parameter_group.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace organ_collision;
using XmlRpc::XmlRpcValue;

namespace {

const NumberRange kPositive{0.0, std::numeric_limits<double>::infinity(), false};
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

template <typename Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const ParameterError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST(ParameterGroup, TakesLegalValues) {
  EXPECT_EQ(group_of(2.5).number("x", {}, kPositive), 2.5);
  EXPECT_EQ(group_of(2).number("x", {}, kPositive), 2.0);
  EXPECT_EQ(group_of(1).whole_number("x", 5, kOneToTen), 1);
  EXPECT_EQ(group_of(10).whole_number("x", 5, kOneToTen), 10);
  EXPECT_TRUE(group_of(true).flag("x", false));
  EXPECT_EQ(group_of("text").text("x"), "text");
  EXPECT_EQ(group_of("b").choice("x", "a", {"a", "b"}), "b");
  EXPECT_EQ(group_of(list_of("b", "a")).texts("x"), (std::vector<std::string>{"b", "a"}));
}

TEST(ParameterGroup, TakesDefaults) {
  const ParameterGroup group = group_of(2.5);
  EXPECT_EQ(group.number("y", 0.5, kPositive), 0.5);
  EXPECT_EQ(group.whole_number("y", 7, kOneToTen), 7);
  EXPECT_FALSE(group.flag("y", false));
  EXPECT_EQ(group.choice("y", "a", {"a", "b"}), "a");
}

TEST(ParameterGroup, RefusesNamingParameterValueAndWhatIsLegal) {
  EXPECT_EQ(message_of([] { group_of(0.0).number("x", {}, kPositive); }),
            "~g/x is '0'; must be a number, more than 0");
  EXPECT_EQ(message_of([] { group_of(11).whole_number("x", 5, kOneToTen); }),
            "~g/x is '11'; must be a whole number, at least 1, at most 10");
  EXPECT_EQ(message_of([] { group_of("yes").flag("x", true); }),
            "~g/x is 'yes'; must be true or false");
  EXPECT_EQ(message_of([] {
              group_of("c").choice("x", "a", {"a", "b"});
            }),
            "~g/x is 'c'; must be one of a, b");
}

TEST(ParameterGroup, RefusesWhatIsNoFiniteNumber) {
  for (const double value : {std::nan(""), std::numeric_limits<double>::infinity(), -1e-9}) {
    EXPECT_THROW(group_of(value).number("x", {}, kPositive), ParameterError) << value;
  }
}

TEST(ParameterGroup, RefusesOtherTypes) {
  EXPECT_THROW(group_of("2.5").number("x", {}, kPositive), ParameterError);
  EXPECT_THROW(group_of(true).number("x", {}, kPositive), ParameterError);
  EXPECT_THROW(group_of(2.0).whole_number("x", 5, kOneToTen), ParameterError);
  EXPECT_THROW(group_of(1).flag("x", true), ParameterError);
  EXPECT_THROW(group_of(1).text("x"), ParameterError);
  EXPECT_THROW(group_of("").text("x"), ParameterError);
  EXPECT_THROW(group_of(1).choice("x", "a", {"a", "1"}), ParameterError);
  EXPECT_THROW(group_of("text").list("x", "tools"), ParameterError);
  EXPECT_THROW(group_of("text").texts("x"), ParameterError);
  EXPECT_THROW(group_of(list_of("a", 1)).texts("x"), ParameterError);
}

TEST(ParameterGroup, TextsAreNotEmptyAndEachOnce) {
  XmlRpcValue empty;
  empty.setSize(0);
  const std::string legal = "must be a list, not empty, of texts that are not empty, each once";
  for (const XmlRpcValue& value : {empty, list_of("a", ""), list_of("a", "a")}) {
    const std::string message = message_of([&] { group_of(value).texts("x"); });
    EXPECT_NE(message.find(legal), std::string::npos) << message;
  }
  EXPECT_EQ(message_of([] { group_of(1).texts("y"); }), "~g/y is missing; " + legal);
}

TEST(ParameterGroup, MissingOnesNameWhatMayHaveBeenMeant) {
  XmlRpcValue members;
  members["raduis"] = 0.005;
  const ParameterGroup group("~tools[0]", members, {"name", "radius"});
  const std::string message = message_of([&] { group.number("radius", {}, kPositive); });
  EXPECT_NE(message.find("~tools[0]/radius is missing"), std::string::npos) << message;
  EXPECT_NE(message.find("~tools[0]/raduis is no parameter; nearest is 'radius'"),
            std::string::npos)
      << message;
}

TEST(ParameterGroup, ReportsMisspeltNames) {
  XmlRpcValue members;
  members["x"] = 1;
  members["yy"] = 1;
  const auto misspelt = ParameterGroup("~", members, {"x", "y"}).misspelt();
  ASSERT_EQ(misspelt.size(), 1u);
  EXPECT_EQ(misspelt[0], "~yy is no parameter; nearest is 'y', legal are x, y");
}

TEST(ParameterGroup, MustBeAGroup) {
  EXPECT_EQ(message_of([] { ParameterGroup("~tools[1]", XmlRpcValue("hook"), {"name"}); }),
            "~tools[1] is 'hook'; must be a group of name");
}
