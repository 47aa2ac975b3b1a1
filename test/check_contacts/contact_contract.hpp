#pragma once

#include <organ_collision/ContactArray.h>
#include <ros/time.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "answer_rules.hpp"

namespace organ_collision {

/// The contract of a topic `contacts`: that of each answer, and that the steps of each organ and
/// tool join. Takes the answers of one topic in the order in which they came.
class ContactContract {
 public:
  /// `publisher`: the node that sent the answer. Each publisher counts its messages in header.seq.
  Faults check(const ContactArray& answer, const std::string& publisher);

  /// Messages that the publishers counted, but that did not come.
  std::uint64_t lost() const { return lost_; }

 private:
  /// What is known of a publisher's last steps.
  struct Stream {
    std::optional<std::uint32_t> seq;  ///< of its last answer
    /// The end of the last successful step, by organ and tool.
    std::map<std::pair<std::string, std::string>, ros::Time> ends;
  };

  void follow(const ContactArray& answer, Stream& stream);
  static void check_start(const ContactArray& answer, const Stream& stream, Faults& faults);

  std::map<std::string, Stream> streams_;  ///< by publisher
  std::uint64_t lost_ = 0;
};

}  // namespace organ_collision
