#include "rrt_connect.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace rrt_connect {
namespace {

class Tree {
 public:
  explicit Tree(const Path& roots) : nodes_(roots), parents_(roots.size()) {}

  const Place& node(std::size_t number) const { return nodes_[number]; }

  /// Goes from the nearest node as far as it can. Returns the new node, or nothing.
  std::optional<std::size_t> grow(const Place& towards, const Advance& advance) {
    const auto is_nearer = [&](const Place& a, const Place& b) {
      return (a - towards).squaredNorm() < (b - towards).squaredNorm();
    };
    const auto nearest = std::min_element(nodes_.begin(), nodes_.end(), is_nearer);
    const Place end = advance(*nearest, towards);
    if (end == *nearest) return std::nullopt;
    parents_.emplace_back(nearest - nodes_.begin());
    nodes_.push_back(end);
    return nodes_.size() - 1;
  }

  Path way_to_root(std::size_t number) const {
    Path way{nodes_[number]};
    for (auto parent = parents_[number]; parent; parent = parents_[*parent]) {
      way.push_back(nodes_[*parent]);
    }
    return way;
  }

 private:
  Path nodes_;
  std::vector<std::optional<std::size_t>> parents_;  // The roots have none.
};

}  // namespace

Path connect(const Place& start, const Path& goals, const Advance& advance, const Sample& sample,
             int most) {
  Tree from_start({start}), from_goals(goals);
  Tree *one = &from_start, *other = &from_goals;
  for (int i = 0; i < most; ++i, std::swap(one, other)) {
    const auto reached = one->grow(sample(), advance);
    if (!reached) continue;
    const auto met = other->grow(one->node(*reached), advance);
    if (!met || other->node(*met) != one->node(*reached)) continue;
    Path path = from_start.way_to_root(one == &from_start ? *reached : *met);
    std::reverse(path.begin(), path.end());
    const Path rest = from_goals.way_to_root(one == &from_start ? *met : *reached);
    path.insert(path.end(), rest.begin() + 1, rest.end());
    return path;
  }
  return {};
}

Path shortened(Path path, const Advance& advance, std::mt19937& random, int attempts) {
  for (int i = 0; i < attempts && path.size() > 2; ++i) {
    std::uniform_int_distribution<std::size_t> any(0, path.size() - 1);
    const auto [first, last] = std::minmax({any(random), any(random)});
    if (last - first < 2 || advance(path[first], path[last]) != path[last]) continue;
    path.erase(path.begin() + static_cast<long>(first) + 1, path.begin() + static_cast<long>(last));
  }
  return path;
}

}  // namespace rrt_connect
