#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "common/messages/robot_reply.hpp"
#include "test/refusals.hpp"

namespace organ_collision {

/// The URL of a file of test/data/tools.
inline std::string tool_file(const std::string& name) {
  return "package://organ_collision/test/data/tools/" + name;
}

/// The content of such a file.
inline std::string tool_text(const std::string& name) {
  std::ifstream file(ORGAN_COLLISION_TEST_DATA "/tools/" + name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The message of the ToolError that `action` throws. The test fails if it throws none.
template <typename Action>
std::string tool_error(const Action& action) {
  const std::string message = refusal_by<ToolError>(action);
  EXPECT_NE(message, "accepted");
  return message;
}

}  // namespace organ_collision
