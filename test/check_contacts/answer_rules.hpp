#pragma once

#include <organ_collision/ContactArray.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/concatenate.hpp"

namespace organ_collision {

/// A rule of the contract that an answer breaks.
struct Fault {
  std::string rule;          ///< one of a few fixed texts, for example "unit normal"
  std::string sentence;      ///< the first place that breaks it, the value, and what is legal
  std::uint64_t places = 1;  ///< how many places of the answer break it
};

/// All rules that one answer breaks, each once.
class Faults {
 public:
  /// `parts`: the sentence. It is only put together if the rule is broken for the first time.
  template <typename... Parts>
  void add(const char* rule, const Parts&... parts) {
    const auto known = std::find_if(faults_.begin(), faults_.end(),
                                    [&](const Fault& fault) { return fault.rule == rule; });
    if (known != faults_.end()) {
      ++known->places;
    } else {
      faults_.push_back({rule, concatenate(parts...)});
    }
  }

  bool empty() const { return faults_.empty(); }
  const std::vector<Fault>& all() const { return faults_; }

 private:
  std::vector<Fault> faults_;
};

/// What one answer on `contacts`, or of a service, breaks of the contract in ContactArray.msg and
/// the messages in it. Paper modes have no geometry: of their contacts, only the order is checked.
Faults check_answer(const ContactArray& answer);

}  // namespace organ_collision
