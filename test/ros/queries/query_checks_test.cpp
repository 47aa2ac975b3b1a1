#include "ros/queries/query_checks.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "test/ros/tools/hand_made_tools.hpp"

using namespace organ_collision;

namespace {

/// The status with which a check refuses, and its message; OK: it does not refuse.
std::pair<int, std::string> refusal(const std::function<void()>& check) {
  try {
    check();
  } catch (const Rejection& rejection) {
    return {rejection.status(), rejection.what()};
  }
  return {ContactArray::OK, ""};
}

}  // namespace

TEST(QueryChecks, RefusalsNameAllParts) {
  const auto [status, message] = refusal([] { refuse("margin is ", -0.5, " m"); });
  EXPECT_EQ(status, ContactArray::INVALID_REQUEST);
  EXPECT_EQ(message, "margin is -0.5 m");
}

TEST(QueryChecks, Modes) {
  for (int mode = 0; mode <= ContactArray::PAPER_NAIVE; ++mode) {
    EXPECT_EQ(static_cast<int>(checked_mode(static_cast<std::uint8_t>(mode))), mode);
  }
  EXPECT_EQ(refusal([] { checked_mode(255); }).second,
            "mode is 255; legal are 0 (STATIC) to 4 (PAPER_NAIVE)");
}

TEST(QueryChecks, Tools) {
  Tool faulty = grasper();
  faulty.fault = "grasper: no URDF";
  const auto of_fault = refusal([&] { check_tool(faulty, QueryMode::kPaperNaive); });
  EXPECT_EQ(of_fault.first, ContactArray::INVALID_TOOL);
  EXPECT_EQ(of_fault.second, "grasper: no URDF");
  for (const QueryMode mode : {QueryMode::kStatic, QueryMode::kSwept}) {
    EXPECT_EQ(refusal([&] { check_tool(grasper(), mode); }).first, ContactArray::OK);
  }
  for (const QueryMode mode :
       {QueryMode::kPaperStatic, QueryMode::kPaperSwept, QueryMode::kPaperNaive}) {
    const auto refused = refusal([&] { check_tool(grasper(), mode); });
    EXPECT_EQ(refused.first, ContactArray::INVALID_REQUEST);
    EXPECT_NE(refused.second.find("'grasper' has no shaft"), std::string::npos) << refused.second;
    EXPECT_EQ(refusal([&] { check_tool(shaft_tool("hook", 0.01), mode); }).first, ContactArray::OK);
  }
}
