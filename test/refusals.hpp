#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace organ_collision {

/// What the Error says that a call throws, or "accepted" if it throws none.
template <typename Error, typename Call>
std::string refusal_by(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

inline void expect_words(const std::string& message, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    EXPECT_NE(message.find(word), std::string::npos) << "'" << word << "' in: " << message;
  }
}

}  // namespace organ_collision
