#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <string>

#include "common/program/user_input.hpp"

namespace organ_collision {

/// A file with a given content. The destructor removes it.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& content, const std::string& ending = {}) {
    static int count = 0;
    path_ = testing::TempDir() + "organ_collision_programs_" + std::to_string(getpid()) + "_" +
            std::to_string(++count) + ending;
    std::ofstream(path_, std::ios::binary) << content;
  }
  ~TemporaryFile() { std::remove(path_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// The message of the InputError that `action` throws. The test fails if it throws none, or if the
/// message has several lines.
template <typename Action>
std::string input_error(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }
  ADD_FAILURE() << "nothing was refused";
  return {};
}

/// The message for a file with this content that `read` refuses, without the file's name at its
/// beginning.
template <typename Read>
std::string refusal_of(const std::string& content, const Read& read,
                       const std::string& ending = {}) {
  const TemporaryFile file(content, ending);
  const std::string message = input_error([&] { read(file.path()); });
  EXPECT_EQ(message.find(file.path()), 0U) << message;
  return message.substr(std::min(message.size(), file.path().size()));
}

}  // namespace organ_collision
