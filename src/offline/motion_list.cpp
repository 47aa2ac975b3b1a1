#include "motion_list.hpp"

#include <algorithm>
#include <numeric>
#include <string_view>
#include <utility>

#include "motion_reader.hpp"
#include "text_reader.hpp"

namespace organ_collision {

MotionList::MotionList(std::string file, Order order) : file_(std::move(file)) {
  MotionReader reader(file_);
  while (std::optional<Motion> motion = reader.next()) motions_.push_back(std::move(*motion));

  const bool all_integers = std::all_of(motions_.begin(), motions_.end(), [](const Motion& motion) {
    return parse_integer(motion.query).has_value();
  });
  const auto text = [](const Motion& motion) { return std::string_view(motion.query); };
  const auto value = [](const Motion& motion) { return *parse_integer(motion.query); };
  order_ = all_integers ? sorted_by(value) : sorted_by(text);
  if (order == Order::kAsInFile) std::iota(order_.begin(), order_.end(), std::size_t{0});
}

std::optional<Motion> MotionList::next() {
  if (next_ == order_.size()) return std::nullopt;
  return motions_[order_[next_++]];
}

/// The indices of all motions by rising `key`. Throws InputError if two keys are equal.
template <typename Key>
std::vector<std::size_t> MotionList::sorted_by(const Key& key) const {
  std::vector<std::pair<decltype(key(motions_[0])), std::size_t>> keys;
  keys.reserve(motions_.size());
  for (const Motion& motion : motions_) keys.emplace_back(key(motion), keys.size());
  std::sort(keys.begin(), keys.end());
  const auto same = std::adjacent_find(
      keys.begin(), keys.end(), [](const auto& a, const auto& b) { return a.first == b.first; });
  if (same != keys.end()) {
    const Motion &first = motions_[same->second], &second = motions_[std::next(same)->second];
    throw InputError(file_, second.line,
                     "query " + in_quotes(second.query) + " is already on line " +
                         std::to_string(first.line) + "; each motion needs its own");
  }
  std::vector<std::size_t> order;
  order.reserve(keys.size());
  for (const auto& [unused, index] : keys) order.push_back(index);
  return order;
}

}  // namespace organ_collision
