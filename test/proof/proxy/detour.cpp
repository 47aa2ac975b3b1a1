#include "detour.hpp"

#include <algorithm>

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;

constexpr double kMeets = 1e-6;  // [m]

/// The lines at one time of the step, in [0, 1].
struct Stop {
  std::vector<ShaftAxis> lines;
  double time;
};

double longest_way(const Stop& from, const Stop& to) {
  double most = 0.0;
  for (std::size_t i = 0; i < from.lines.size(); ++i) {
    most = std::max({most, (to.lines[i].tip - from.lines[i].tip).norm(),
                     (to.lines[i].trocar - from.lines[i].trocar).norm()});
  }
  return most;
}

class Search {
 public:
  Search(const OrganOracle& organ, bool holds_trocar, Random& random)
      : organ_(organ), holds_trocar_(holds_trocar), random_(random) {}

  /// Tries the straight motion, then motions with a stop on the way. The two parts of these may
  /// have stops themselves, down to so many levels.
  bool is_way(const Stop& from, const Stop& to, int levels) {
    std::vector<ShaftMotion> motions;
    for (std::size_t i = 0; i < from.lines.size(); ++i) {
      motions.push_back({from.lines[i], to.lines[i]});
    }
    if (!organ_.is_passed(motions, from.time, to.time, kMeets)) return true;
    const int stops = levels == 2 ? 40 : levels == 1 ? 6 : 0;
    for (int i = 0; i < stops; ++i) {
      const Stop via = stop_between(from, to);
      if (is_way(from, via, levels - 1) && is_way(via, to, levels - 1)) return true;
    }
    return false;
  }

 private:
  Stop stop_between(const Stop& from, const Stop& to) {
    const Vector3d beside = random_.uniform(0.0, longest_way(from, to)) * random_.direction();
    Stop stop{{}, 0.5 * (from.time + to.time)};
    for (std::size_t i = 0; i < from.lines.size(); ++i) {
      ShaftAxis line = ShaftMotion{from.lines[i], to.lines[i]}.at(0.5);
      line.tip += beside;
      if (i > 0 || !holds_trocar_) line.trocar += beside;
      stop.lines.push_back(line);
    }
    return stop;
  }

  const OrganOracle& organ_;
  bool holds_trocar_;
  Random& random_;
};

}  // namespace

bool has_detour(const OrganOracle& organ, const std::vector<ShaftAxis>& from,
                const std::vector<ShaftAxis>& to, bool holds_trocar, Random& random) {
  Search search(organ, holds_trocar, random);
  const Stop start{from, 0.0}, end{to, 1.0};
  if (search.is_way(start, end, 2)) return true;
  if (!holds_trocar || from.size() > 1) return false;
  const Stop withdrawn{{{from.front().trocar, from.front().trocar}}, 0.5};
  return search.is_way(start, withdrawn, 0) && search.is_way(withdrawn, end, 2);
}

}  // namespace organ_collision::oracle
