#pragma once

#include <organ_collision/ContactArray.h>
#include <ros/time.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/concatenate.hpp"

namespace organ_collision {

/// A rule of the contract that an answer breaks.
struct Fault {
  std::string rule;      ///< one of a few fixed texts, for example "unit normal"
  std::string sentence;  ///< the first place that breaks it, the value, and what is legal
};

/// All rules that one answer breaks, each once.
class Faults {
 public:
  /// `parts`: the sentence. It is only put together if the rule is broken for the first time.
  template <typename... Parts>
  void add(const char* rule, const Parts&... parts) {
    const bool is_known = std::any_of(faults_.begin(), faults_.end(),
                                      [&](const Fault& fault) { return fault.rule == rule; });
    if (!is_known) faults_.push_back({rule, concatenate(parts...)});
  }

  bool empty() const { return faults_.empty(); }
  const std::vector<Fault>& all() const { return faults_; }

 private:
  std::vector<Fault> faults_;
};

/// What one answer on `contacts`, or of a service, breaks of the contract in ContactArray.msg and
/// the messages in it. Paper modes have no geometry: of their contacts, only the order is checked.
Faults check_answer(const ContactArray& answer);

/// The contract of a topic `contacts`: that of each answer, that the steps of each organ and tool
/// join, and that contacts go on from step to step. Takes the answers of one topic in the order in
/// which they came.
class ContactContract {
 public:
  /// `publisher`: the node that sent the answer. Each publisher counts its messages in header.seq.
  Faults check(const ContactArray& answer, const std::string& publisher);

  /// Messages that the publishers counted, but that did not come.
  std::uint64_t lost() const { return lost_; }

 private:
  /// What the last successful step of an organ and a tool ended with.
  struct LastAnswer {
    ros::Time end;
    std::uint32_t topology;
    /// Since when they touch: the contacts that were touching, by face and link.
    std::map<std::pair<std::uint32_t, std::int32_t>, ros::Time> touching;
  };

  /// What is known of a publisher's last steps.
  struct Stream {
    std::optional<std::uint32_t> seq;                                     ///< of its last answer
    std::map<std::pair<std::string, std::string>, LastAnswer> last = {};  ///< by organ and tool
  };

  void follow(const ContactArray& answer, Stream& stream);
  static void check_start(const ContactArray& answer, const LastAnswer& last, Faults& faults);
  static void check_memory(const ContactArray& answer, const LastAnswer* last, Faults& faults);

  std::map<std::string, Stream> streams_;  ///< by publisher
  std::uint64_t lost_ = 0;
};

}  // namespace organ_collision
