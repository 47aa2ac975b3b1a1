#include "judge.hpp"

#include <rosgraph_msgs/Clock.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <sstream>

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
