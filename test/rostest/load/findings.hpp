#pragma once

#include <organ_collision/ContactArray.h>

#include <cstddef>
#include <mutex>
#include <set>
#include <string>

#include "check_contacts/contact_contract.hpp"

namespace organ_collision::stress {

/// What all threads of the test found wrong, and how many answers they checked.
class Findings {
 public:
  /// An answer of a service.
  void check(const std::string& source, const ContactArray& answer);
  /// An answer on `contacts`, in the order in which they came.
  void check_step(const ContactArray& answer, const std::string& publisher);
  void add(const std::string& sentence);

  std::size_t checked() const;
  /// How many of the checked answers are OK.
  std::size_t answered() const;
  /// One line for each kind of finding; empty if there are none.
  std::string text() const;

 private:
  void count(const std::string& source, const ContactArray& answer, const Faults& faults);

  ContactContract steps_;
  mutable std::mutex mutex_;
  std::size_t checked_ = 0, answered_ = 0;
  std::set<std::string> sentences_;
};

}  // namespace organ_collision::stress
