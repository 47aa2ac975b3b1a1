#include "step_history.hpp"

#include <algorithm>

namespace organ_collision {

void ShapeQueue::pop() {
  waiting_ = std::move(newest_);
  newest_.reset();
}

void ShapeQueue::clear() {
  waiting_.reset();
  newest_.reset();
}

const LastStep* StepHistory::last(const std::string& organ, std::size_t tool) const {
  const auto pair = pairs_.find({organ, tool});
  return pair != pairs_.end() && pair->second.last ? &*pair->second.last : nullptr;
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
    pairs_.insert({{key.first, tool}, std::move(pair)});
  }
}

}  // namespace organ_collision
