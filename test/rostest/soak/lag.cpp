#include "lag.hpp"

#include <algorithm>

namespace organ_collision::soak {
namespace {

/// Older ticks are forgotten.
constexpr std::uint64_t kKept = 20'000;

}  // namespace

Lag::Lag()
    : contacts_(node_.subscribe<ContactArray>(
          "organ_collision/contacts", 1000,
          [this](const ContactArrayConstPtr& answer) { take(*answer); })) {}

void Lag::add(Tick tick) {
  const std::lock_guard lock(mutex_);
  sent_[tick] = ++count_;
  if (sent_.size() <= 2 * kKept) return;
  for (auto sent = sent_.begin(); sent != sent_.end();) {
    sent = sent->second + kKept < count_ ? sent_.erase(sent) : std::next(sent);
  }
}

std::uint64_t Lag::ticks() const {
  const std::lock_guard lock(mutex_);
  return count_ - answered_;
}

void Lag::take(const ContactArray& answer) {
  const std::lock_guard lock(mutex_);
  for (const ros::Time stamp : {answer.header.stamp, answer.mesh_stamp}) {
    const auto sent = sent_.find(tick_of(stamp));
    if (sent != sent_.end()) answered_ = std::max(answered_, sent->second);
  }
}

}  // namespace organ_collision::soak
