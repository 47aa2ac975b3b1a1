#pragma once

#include <string>

namespace organ_collision {

/// A file that exists only in memory, for readers that take the name of a file.
class MemoryFile {
 public:
  /// Throws std::system_error.
  MemoryFile();
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  /// Replaces its content. Throws std::system_error.
  void write(const std::string& content);
  /// Its name in this process.
  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

}  // namespace organ_collision
