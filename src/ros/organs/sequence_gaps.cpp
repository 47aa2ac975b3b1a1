#include "sequence_gaps.hpp"

#include <utility>

namespace organ_collision {
namespace {

/// Publishers may have a new name at each start. If there were so many, all are forgotten.
constexpr std::size_t kMostPublishers = 1000;

}  // namespace

std::uint64_t SequenceGaps::add(const std::string& publisher, std::uint32_t number) {
  const auto known = last_.find(publisher);
  if (known == last_.end()) {
    if (last_.size() == kMostPublishers) last_.clear();
    last_.emplace(publisher, number);
    return 0;
  }
  const std::uint32_t last = std::exchange(known->second, number);
  return number > last ? number - last - 1 : 0;
}

}  // namespace organ_collision
