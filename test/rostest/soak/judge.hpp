#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <organ_collision/ContactArray.h>
#include <ros/node_handle.h>

#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <ostream>
#include <string>
#include <thread>

#include "accounts.hpp"
#include "script.hpp"
#include "second_evaluation.hpp"
#include "test/rostest/load/findings.hpp"

namespace organ_collision::soak {

/// Reads all that a node answers and counts. Each answer must keep its contract. As many as the
/// processor has time for are evaluated a second time. Whenever the node tells its counts, they
/// must add up.
class Judge {
 public:
  explicit Judge(std::uint64_t seed);
  ~Judge();
  Judge(const Judge&) = delete;
  Judge& operator=(const Judge&) = delete;

  /// Whether the node publishes what this reads. The simulator comes later.
  bool is_connected() const;
  /// Prints all that it knows as JSON, in one line.
  void report(std::ostream& out) const;

 private:
  void take(const ContactArrayConstPtr& answer);
  void count_losses(std::uint32_t number);
  void offer(const AnsweredStep& step);
  bool is_ahead(const std::string& tool) const;
  bool may_not_know_of_jump(const ContactArray& answer);
  void work();

  const Script script_;
  stress::Findings findings_;

  mutable std::mutex mutex_;  ///< guards what follows, up to the next empty line
  Accounts accounts_;
  std::map<std::string, ContactArrayConstPtr> latest_;  ///< by tool: the last good answer
  std::map<std::string, ros::Time> before_jump_;        ///< by tool, until it is known to be over
  std::optional<std::uint32_t> last_number_;
  std::uint64_t lost_ = 0, sums_ = 0, rechecked_ = 0, rechecked_contacts_ = 0, empty_ = 0;
  std::map<std::string, std::uint64_t> evaluations_;      ///< by tool
  std::map<std::string, std::uint64_t> rechecked_tools_;  ///< by mode and tool
  std::map<int, std::uint64_t> statuses_;
  std::map<std::string, std::uint64_t> not_checkable_;
  std::optional<AnsweredStep> next_;
  bool stop_ = false;

  std::condition_variable has_work_;
  std::thread thread_;
  ros::NodeHandle node_;
  ros::Subscriber contacts_, diagnostics_, jumps_;
};

}  // namespace organ_collision::soak
