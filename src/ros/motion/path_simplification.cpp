#include "path_simplification.hpp"

#include <algorithm>
#include <queue>
#include <utility>
#include <vector>

namespace organ_collision {
namespace {

/// The straight motion between two waypoints, and the waypoint in between that deviates most.
struct Leg {
  std::size_t begin, end, farthest;
  double deviation = 0.0;  ///< [m]

  bool operator<(const Leg& other) const { return deviation < other.deviation; }
};

Leg straight_leg(const ToolPath& path, const PathDeviation& deviation, std::size_t begin,
                 std::size_t end) {
  Leg leg{begin, end, begin};
  const StraightMotion motion(path[begin], path[end]);
  for (std::size_t i = begin + 1; i < end; ++i) {
    const double most = deviation(path[i], motion).most();
    if (most > leg.deviation) {
      leg.deviation = most;
      leg.farthest = i;
    }
  }
  return leg;
}

}  // namespace

SimplifiedPath simplify_path(ToolPath path, const PathDeviation& deviation, std::size_t legs_max) {
  if (path.size() <= legs_max + 1) return {std::move(path)};
  std::priority_queue<Leg> legs;
  legs.push(straight_leg(path, deviation, 0, path.size() - 1));
  std::vector<std::size_t> kept = {0, path.size() - 1};
  while (legs.size() < legs_max && legs.top().deviation > 0.0) {
    const Leg leg = legs.top();
    legs.pop();
    legs.push(straight_leg(path, deviation, leg.begin, leg.farthest));
    legs.push(straight_leg(path, deviation, leg.farthest, leg.end));
    kept.push_back(leg.farthest);
  }
  std::sort(kept.begin(), kept.end());
  SimplifiedPath result{{}, path.size() - kept.size(), legs.top().deviation};
  for (const std::size_t waypoint : kept) result.path.push_back(std::move(path[waypoint]));
  return result;
}

}  // namespace organ_collision
