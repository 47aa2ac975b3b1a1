#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "mesh_adapter/message_error.hpp"

namespace organ_collision {

/// The reason and message with which a call refuses, as "reason: message".
template <typename Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const MessageError& error) {
    return error.reason() + ": " + error.what();
  }
  return "accepted";
}

inline void expect_words(const std::string& message, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    EXPECT_NE(message.find(word), std::string::npos) << "'" << word << "' in: " << message;
  }
}

}  // namespace organ_collision
