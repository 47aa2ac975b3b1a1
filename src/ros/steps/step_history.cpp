#include "step_history.hpp"

#include <algorithm>

namespace organ_collision {

SteadyTime WaitClock::now() {
  const bool simulates = ros::Time::isSimTime();
  return now(simulates ? std::optional(ros::Time::now()) : std::nullopt,
             std::chrono::steady_clock::now());
}

SteadyTime WaitClock::now(std::optional<ros::Time> simulated, SteadyTime wall) {
  if (!simulated) return wall;
  if (*simulated != simulated_) {
    // The first time of the simulator is no duration.
    if (*simulated > simulated_ && !simulated_.isZero()) {
      time_ += std::chrono::nanoseconds(simulated->toNSec() - simulated_.toNSec());
    }
    simulated_ = *simulated;
    counted_ = wall;
  } else if (wall - counted_ > kStandstill) {
    time_ += wall - counted_ - kStandstill;
    counted_ = wall - kStandstill;
  }
  return time_;
}

const LastStep* StepHistory::last(const std::string& organ, std::size_t tool) const {
  const auto pair = pairs_.find({organ, tool});
  return pair != pairs_.end() && pair->second.last ? &*pair->second.last : nullptr;
}

std::size_t StepHistory::waiting() const {
  std::size_t waiting = 0;
  for (const auto& [key, pair] : pairs_) waiting += pair.waiting.size();
  return waiting;
}

void StepHistory::forget(const std::string& organ) {
  const auto first = pairs_.lower_bound({organ, 0});
  auto end = first;
  while (end != pairs_.end() && end->first.first == organ) ++end;
  pairs_.erase(first, end);
}

void StepHistory::renumber(const KeptTools& kept) {
  Pairs old;
  old.swap(pairs_);
  for (auto& [key, pair] : old) {
    const auto now = std::find(kept.begin(), kept.end(), key.second);
    if (now == kept.end()) continue;
    const auto tool = static_cast<std::size_t>(now - kept.begin());
    pairs_.emplace(std::make_pair(key.first, tool), std::move(pair));
  }
}

}  // namespace organ_collision
