#pragma once

#include <organ_collision/ContactArray.h>

#include <cstddef>
#include <mutex>
#include <set>
#include <string>

namespace organ_collision::stress {

/// What all threads of the test found wrong, and how many answers they checked.
class Findings {
 public:
  void check(const std::string& source, const ContactArray& answer);
  void add(const std::string& sentence);

  std::size_t checked() const;
  /// How many of the checked answers are OK.
  std::size_t answered() const;
  /// One line for each kind of finding; empty if there are none.
  std::string text() const;

 private:
  mutable std::mutex mutex_;
  std::size_t checked_ = 0, answered_ = 0;
  std::set<std::string> sentences_;
};

}  // namespace organ_collision::stress
