#include <diagnostic_msgs/DiagnosticArray.h>
#include <organ_collision/ContactArray.h>
#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <rosgraph_msgs/Clock.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <map>
#include <mutex>
#include <optional>
#include <ostream>
#include <sstream>
#include <string>
#include <thread>

#include "load.hpp"
#include "second_evaluation.hpp"
#include "soak_script.hpp"

namespace organ_collision::soak {

/// What the node itself counts, as /diagnostics tells it (doc/interface.md).
class Accounts {
 public:
  void add(const diagnostic_msgs::DiagnosticArray& message);

  /// Which sum is wrong; empty: none is. `tools`: how many the node has.
  std::string wrong_sum(std::uint64_t tools) const;
  /// 0 if the node has not told it.
  std::uint64_t count(const std::string& key) const;
  const std::map<std::string, std::uint64_t>& counts() const { return counts_; }

 private:
  std::map<std::string, std::uint64_t> counts_;
};

namespace {

bool is_count(const std::string& value) {
  return !value.empty() &&
         std::all_of(value.begin(), value.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool tells_counts(const std::string& task) {
  const auto ends_with = [&](const std::string& end) {
    return task.size() >= end.size() && task.substr(task.size() - end.size()) == end;
  };
  return ends_with(": queries") || ends_with(": messages");
}

}  // namespace

void Accounts::add(const diagnostic_msgs::DiagnosticArray& message) {
  for (const diagnostic_msgs::DiagnosticStatus& status : message.status) {
    if (!tells_counts(status.name)) continue;
    for (const diagnostic_msgs::KeyValue& pair : status.values) {
      if (is_count(pair.value)) counts_[pair.key] = std::strtoull(pair.value.c_str(), nullptr, 10);
    }
  }
}

std::string Accounts::wrong_sum(std::uint64_t tools) const {
  if (count("organ messages received") !=
      count("organ messages applied") + count("organ messages that remove") +
          count("organ messages refused") + count("organ messages dropped behind a large mesh") +
          count("organ messages waiting")) {
    return "the node's counts of organ messages do not add up";
  }
  if (count("shapes due") != tools * count("organ messages applied")) {
    return "not every accepted shape became due for each tool";
  }
  if (count("shapes due") != count("shapes answered") + count("shapes superseded by newer ones") +
                                 count("shapes forgotten before their step") +
                                 count("shapes waiting")) {
    return "the node's counts of shapes do not add up";
  }
  return "";
}

std::uint64_t Accounts::count(const std::string& key) const {
  const auto found = counts_.find(key);
  return found == counts_.end() ? 0 : found->second;
}

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

template <typename Map>
void print_map(std::ostream& out, const Map& map) {
  out << '{';
  const char* separator = "";
  for (const auto& [key, value] : map) {
    out << separator << '"' << key << "\": " << value;
    separator = ", ";
  }
  out << '}';
}

}  // namespace

Judge::Judge(std::uint64_t seed) : script_(seed), thread_([this] { work(); }) {
  contacts_ =
      node_.subscribe<ContactArray>("organ_collision/contacts", kQueue,
                                    [this](const ContactArrayConstPtr& answer) { take(answer); });
  diagnostics_ = node_.subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", kQueue, [this](const diagnostic_msgs::DiagnosticArrayConstPtr& message) {
        const std::lock_guard lock(mutex_);
        accounts_.add(*message);
        ++sums_;
        const std::string wrong = accounts_.wrong_sum(kTools.size());
        if (!wrong.empty()) findings_.add(wrong);
      });
  jumps_ = node_.subscribe<rosgraph_msgs::Clock>(
      kJumps, kQueue, [this](const rosgraph_msgs::ClockConstPtr& before) {
        const std::lock_guard lock(mutex_);
        for (const std::string& tool : kTools) {
          before_jump_[tool] = std::max(before_jump_[tool], before->clock);
        }
      });
}

Judge::~Judge() {
  contacts_.shutdown();
  diagnostics_.shutdown();
  jumps_.shutdown();
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  has_work_.notify_one();
  thread_.join();
}

bool Judge::is_connected() const {
  return contacts_.getNumPublishers() > 0 && diagnostics_.getNumPublishers() > 0;
}

void Judge::take(const ContactArrayConstPtr& answer) {
  findings_.check_step(*answer, "contacts");
  const std::lock_guard lock(mutex_);
  count_losses(answer->header.seq);
  ++statuses_[answer->status];
  if (answer->status != ContactArray::OK || answer->organ != kOrgan) return;
  ContactArrayConstPtr& latest = latest_[answer->tool];
  if (may_not_know_of_jump(*answer)) {
    ++not_checkable_["a jump of the clock"];
  } else {
    offer({answer, latest});
  }
  latest = answer;
}

/// A node that was stopped may miss a jump back, if the clock is ahead of what the node has seen
/// last when it goes on (doc/bags.md). Until the clock has passed the time before the jump again,
/// TF has poses of both times. A node that has noticed the jump begins with a static step.
bool Judge::may_not_know_of_jump(const ContactArray& answer) {
  const auto jump = before_jump_.find(answer.tool);
  if (jump == before_jump_.end()) return false;
  const bool is_over = answer.mode == ContactArray::STATIC || answer.step_start > jump->second;
  if (is_over) before_jump_.erase(jump);
  return !is_over;
}

/// roscpp numbers the messages of a publisher from 0.
void Judge::count_losses(std::uint32_t number) {
  const std::uint32_t expected = last_number_ ? *last_number_ + 1 : 0;
  last_number_ = number;
  if (number == expected) return;
  lost_ += number - expected;
  latest_.clear();
}

/// For the thread of second evaluations, if it has nothing to do. No tool gets far ahead of the
/// others, whose answers come at the same moments.
void Judge::offer(const AnsweredStep& step) {
  if (next_ || is_ahead(step.answer->tool)) return;
  const std::string why_not = why_not_checkable(script_, step);
  if (!why_not.empty()) {
    ++not_checkable_[why_not];
    return;
  }
  next_ = step;
  has_work_.notify_one();
}

bool Judge::is_ahead(const std::string& tool) const {
  const auto count = [this](const std::string& other) {
    const auto found = evaluations_.find(other);
    return found == evaluations_.end() ? 0 : found->second;
  };
  return std::any_of(kTools.begin(), kTools.end(), [&](const std::string& other) {
    return count(tool) >= count(other) + kMostAhead;
  });
}

void Judge::work() {
  setpriority(PRIO_PROCESS, 0, kNiceness);  // of this thread only
  std::unique_lock lock(mutex_);
  while (true) {
    has_work_.wait(lock, [this] { return stop_ || next_; });
    if (stop_) return;
    const AnsweredStep step = *next_;
    lock.unlock();
    const std::optional<std::string> wrong = wrong_contacts(script_, step);
    if (wrong && !wrong->empty()) findings_.add(*wrong + " (" + told(step) + ")");
    lock.lock();
    next_.reset();
    ++evaluations_[step.answer->tool];
    if (!wrong) {
      ++not_checkable_["the second evaluation is undecided"];
      continue;
    }
    ++rechecked_;
    ++rechecked_tools_[(step.answer->mode == ContactArray::SWEPT ? "swept " : "static ") +
                       step.answer->tool];
    rechecked_contacts_ += step.answer->contacts.size();
    empty_ += step.answer->contacts.empty();
  }
}

void Judge::report(std::ostream& out) const {
  const std::lock_guard lock(mutex_);
  out << "{\"answers\": " << findings_.checked() << ", \"ok\": " << findings_.answered()
      << ", \"lost\": " << lost_ << ", \"rechecked\": " << rechecked_
      << ", \"rechecked contacts\": " << rechecked_contacts_
      << ", \"rechecked without contacts\": " << empty_ << ", \"sums\": " << sums_
      << ", \"rechecked tools\": ";
  print_map(out, rechecked_tools_);
  out << ", \"statuses\": ";
  print_map(out, statuses_);
  out << ", \"not checkable\": ";
  print_map(out, not_checkable_);
  out << ", \"counts\": ";
  print_map(out, accounts_.counts());
  out << ", \"findings\": [";
  const char* separator = "\"";
  std::istringstream sentences(findings_.text());
  for (std::string sentence; std::getline(sentences, sentence);) {
    out << separator << sentence << '"';
    separator = ", \"";
  }
  out << "]}" << std::endl;
}

}  // namespace organ_collision::soak

// The judge of run_soak. It prints an empty line when the node publishes. At each line on standard
// input, it prints a report as JSON. It ends when standard input is closed.

int main(int argc, char** argv) {
  ros::init(argc, argv, "judge");
  if (argc != 2) {
    std::cerr << "Usage: soak_judge SEED\n";
    return 2;
  }
  organ_collision::soak::Judge judge(std::strtoull(argv[1], nullptr, 10));
  ros::AsyncSpinner spinner(1);
  spinner.start();
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!judge.is_connected()) {
    if (std::chrono::steady_clock::now() > give_up) {
      std::cerr << "soak_judge: no node publishes\n";
      return 1;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  std::cout << std::endl;
  for (std::string line; std::getline(std::cin, line);) judge.report(std::cout);
  return 0;
}
