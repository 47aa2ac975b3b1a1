#include <organ_collision/ContactArray.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <condition_variable>
#include <iostream>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <thread>

#include "soak.hpp"
#include "test/check_contacts/contact_contract.hpp"

namespace organ_collision::soak {
namespace {

const std::array<std::string, 4> kTools = {"probe", "needle", "jaw", "stylus"};
constexpr char kOrgan[] = "sheet";
constexpr std::uint32_t kQueue = 100'000;  // [messages]
constexpr int kNiceness = 19;
constexpr std::uint64_t kMostAhead = 5;  // [evaluations] of one tool before another

std::string told(const AnsweredStep& step) {
  const ContactArray& answer = *step.answer;
  std::ostringstream text;
  text << answer.tool << " from " << answer.step_start << " to " << answer.header.stamp
       << ", shape of " << answer.mesh_stamp << ", topology " << answer.topology;
  if (step.before) text << ", before it the shape of " << step.before->mesh_stamp;
  return text.str();
}

/// Reads all that a node answers. Each answer must keep its contract. As many as the processor has
/// time for are evaluated a second time.
class Judge {
 public:
  explicit Judge(std::uint64_t seed) : script_(seed), thread_([this] { work(); }) {
    contacts_ =
        node_.subscribe<ContactArray>("organ_collision/contacts", kQueue,
                                      [this](const ContactArrayConstPtr& answer) { take(answer); });
    jumps_ = node_.subscribe<rosgraph_msgs::Clock>(
        kJumps, kQueue, [this](const rosgraph_msgs::ClockConstPtr& before) {
          const std::lock_guard lock(mutex_);
          for (const std::string& tool : kTools) {
            before_jump_[tool] = std::max(before_jump_[tool], before->clock);
          }
        });
  }
  ~Judge() {
    contacts_.shutdown();
    jumps_.shutdown();
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    has_work_.notify_one();
    thread_.join();
  }
  Judge(const Judge&) = delete;
  Judge& operator=(const Judge&) = delete;

  /// Whether the node publishes what this reads. The simulator comes later.
  bool is_connected() const { return contacts_.getNumPublishers() > 0; }

  /// Prints all that it knows as JSON, in one line.
  void report(std::ostream& out) const {
    const std::lock_guard lock(mutex_);
    out << "{\"answers\": " << answers_ << ", \"ok\": " << ok_ << ", \"lost\": " << lost_
        << ", \"rechecked\": " << rechecked_ << ", \"rechecked contacts\": " << rechecked_contacts_;
    print_json(out << ", \"rechecked tools\": ", rechecked_tools_);
    print_json(out << ", \"statuses\": ", statuses_);
    print_json(out << ", \"not checkable\": ", not_checkable_);
    out << ", \"findings\": [";
    const char* separator = "\"";
    for (const std::string& sentence : findings_) {
      out << separator << sentence << '"';
      separator = ", \"";
    }
    out << "]}" << std::endl;
  }

 private:
  void take(const ContactArrayConstPtr& answer) {
    const std::lock_guard lock(mutex_);
    const Faults faults = contract_.check(*answer, "contacts");
    for (const Fault& fault : faults.all()) findings_.insert(fault.sentence);
    ++answers_;
    ok_ += answer->status == ContactArray::OK;
    ++statuses_[answer->status];
    count_losses(answer->header.seq);
    if (answer->status != ContactArray::OK || answer->organ != kOrgan) return;
    ContactArrayConstPtr& latest = latest_[answer->tool];
    if (may_not_know_of_jump(*answer)) {
      ++not_checkable_["a jump of the clock"];
    } else {
      offer({answer, latest});
    }
    latest = answer;
  }

  /// roscpp numbers the messages of a publisher from 0.
  void count_losses(std::uint32_t number) {
    const std::uint32_t expected = last_number_ ? *last_number_ + 1 : 0;
    last_number_ = number;
    if (number == expected) return;
    lost_ += number - expected;
    latest_.clear();
  }

  /// A node that was stopped may miss a jump back, if the clock is ahead of what the node has seen
  /// last when it goes on (doc/bags.md). Until the clock has passed the time before the jump again,
  /// TF has poses of both times. A node that has noticed the jump begins with a static step.
  bool may_not_know_of_jump(const ContactArray& answer) {
    const auto jump = before_jump_.find(answer.tool);
    if (jump == before_jump_.end()) return false;
    const bool is_over = answer.mode == ContactArray::STATIC || answer.step_start > jump->second;
    if (is_over) before_jump_.erase(jump);
    return !is_over;
  }

  /// For the thread of second evaluations, if it has nothing to do. No tool gets far ahead of the
  /// others, whose answers come at the same moments.
  void offer(const AnsweredStep& step) {
    const std::uint64_t count = evaluations_[step.answer->tool];
    const bool is_ahead = std::any_of(kTools.begin(), kTools.end(), [&](const std::string& other) {
      return count >= evaluations_[other] + kMostAhead;
    });
    if (next_ || is_ahead) return;
    const std::string why_not = why_not_checkable(script_, step);
    if (!why_not.empty()) {
      ++not_checkable_[why_not];
      return;
    }
    next_ = step;
    has_work_.notify_one();
  }

  void work() {
    setpriority(PRIO_PROCESS, 0, kNiceness);  // of this thread only
    std::unique_lock lock(mutex_);
    while (true) {
      has_work_.wait(lock, [this] { return stop_ || next_; });
      if (stop_) return;
      const AnsweredStep step = *next_;
      lock.unlock();
      const std::optional<std::string> wrong = wrong_contacts(script_, step);
      lock.lock();
      next_.reset();
      ++evaluations_[step.answer->tool];
      if (!wrong) {
        ++not_checkable_["the second evaluation is undecided"];
        continue;
      }
      if (!wrong->empty()) findings_.insert(*wrong + " (" + told(step) + ")");
      ++rechecked_;
      ++rechecked_tools_[(step.answer->mode == ContactArray::SWEPT ? "swept " : "static ") +
                         step.answer->tool];
      rechecked_contacts_ += step.answer->contacts.size();
    }
  }

  const Script script_;

  mutable std::mutex mutex_;  ///< guards what follows, up to the next empty line
  ContactContract contract_;
  std::set<std::string> findings_;                      ///< sentences
  std::map<std::string, ContactArrayConstPtr> latest_;  ///< by tool: the last good answer
  std::map<std::string, ros::Time> before_jump_;        ///< by tool, until it is known to be over
  std::optional<std::uint32_t> last_number_;
  std::uint64_t answers_ = 0, ok_ = 0, lost_ = 0, rechecked_ = 0, rechecked_contacts_ = 0;
  std::map<std::string, std::uint64_t> evaluations_;      ///< by tool
  std::map<std::string, std::uint64_t> rechecked_tools_;  ///< by mode and tool
  std::map<int, std::uint64_t> statuses_;
  std::map<std::string, std::uint64_t> not_checkable_;
  std::optional<AnsweredStep> next_;
  bool stop_ = false;

  std::condition_variable has_work_;
  std::thread thread_;
  ros::NodeHandle node_;
  ros::Subscriber contacts_, jumps_;
};

}  // namespace

int judge(std::uint64_t seed) {
  Judge judge(seed);
  ros::AsyncSpinner spinner(1);
  spinner.start();
  if (!wait_for([&] { return judge.is_connected(); })) {
    std::cerr << "soak: no node publishes\n";
    return 1;
  }
  std::cout << std::endl;
  for (std::string line; std::getline(std::cin, line);) judge.report(std::cout);
  return 0;
}

}  // namespace organ_collision::soak
