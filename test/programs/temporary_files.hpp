#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "offline/user_input.hpp"

namespace organ_collision {

/// An empty folder. The destructor removes it with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    static int count = 0;
    path_ = testing::TempDir() + "organ_collision_programs_" + std::to_string(getpid()) + "_" +
            std::to_string(++count);
    std::filesystem::create_directory(path_);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& path() const { return path_; }
  /// Writes a file and returns its path.
  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(path_ + '/' + name, std::ios::binary) << content;
    return path_ + '/' + name;
  }

 private:
  std::string path_;
};

/// A file with a given content. The destructor removes it.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& content) : path_(folder_.write("file", content)) {}
  const std::string& path() const { return path_; }

 private:
  TemporaryFolder folder_;
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
std::string refusal_of(const std::string& content, const Read& read) {
  const TemporaryFile file(content);
  const std::string message = input_error([&] { read(file.path()); });
  EXPECT_EQ(message.find(file.path()), 0U) << message;
  return message.substr(std::min(message.size(), file.path().size()));
}

}  // namespace organ_collision
