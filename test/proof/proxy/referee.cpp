#include "referee.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace organ_collision::oracle {

/// Whether lines could move from one place to another past the tissue, on a few straight legs at
/// random, while the organ moves from its last shape to this one. A proxy that slides along tissue
/// or flies around it moves on several legs in a tick, so the straight motion may cut through
/// tissue that the proxy went around. `holds_trocar`: the first line's trocar only moves straight.
/// If it is the only line, it may also be withdrawn to its trocar, and enter anew.
bool has_detour(const OrganOracle& organ, const std::vector<ShaftAxis>& from,
                const std::vector<ShaftAxis>& to, bool holds_trocar, Random& random);

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

namespace {

constexpr double kRounding = 1e-9;        // [m]
constexpr long kTicksPerSideCheck = 500;  // The exact winding number is slow.
constexpr long kTicksPerWayCheck = 10;
constexpr long kMostClearWays = 3;  // in a row

/// [m] A proxy that tissue holds is so near to the place at the clearance.
double precision(double clearance) { return std::max(1e-6, 0.01 * clearance); }

/// How far a place of the tool is from where the hand has it [m].
double distance_between(const ProxyTool& tool, const ToolPose& a, const ToolPose& b) {
  double most = 0.0;
  const std::vector<ShaftAxis> of_a = skeleton(tool, a), of_b = skeleton(tool, b);
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    most = std::max(
        {most, (of_a[i].trocar - of_b[i].trocar).norm(), (of_a[i].tip - of_b[i].tip).norm()});
  }
  return most;
}

std::string in_mm(const std::string& what, double length) {
  std::ostringstream text;
  text << what << ' ' << 1e3 * length << " mm";
  return text.str();
}

}  // namespace

void ProxyTally::add(const ProxyTally& other) {
  ticks += other.ticks;
  touching += other.touching;
  squeezed += other.squeezed;
  jumps += other.jumps;
  overrun += other.overrun;
  no_answer += other.no_answer;
  near += other.near;
  through += other.through;
  inside += other.inside;
  held += other.held;
  inconsistent += other.inconsistent;
  at_clearance += other.at_clearance;
  least = std::min(least, other.least);
  least_squeezed = std::min(least_squeezed, other.least_squeezed);
  seconds.insert(seconds.end(), other.seconds.begin(), other.seconds.end());
}

Referee::Referee(ProxyTool tool, const ProxySettings& settings, Report report)
    : tool_(std::move(tool)), settings_(settings), report_(std::move(report)) {}

void Referee::blame(long& count, const std::string& what) {
  ++count;
  report_(what);
}

void Referee::count_state(bool jumped, const ProxyAnswer& answer) {
  const bool is_first = tally_.ticks++ == 0;
  if (jumped) ++tally_.jumps;
  if (answer.state == ProxyStatus::kTouching) ++tally_.touching;
  if (answer.state == ProxyStatus::kSqueezed) ++tally_.squeezed;
  if (answer.state == ProxyStatus::kNoAnswer) {
    blame(tally_.no_answer, "no answer: " + answer.message);
  }
  const bool is_due = is_first || jumped;
  if (answer.is_placed_anew && !is_due) {
    blame(tally_.overrun, "placed anew: " + answer.message);
  } else if (!answer.is_placed_anew && is_due) {
    blame(tally_.inconsistent, "not placed anew after a jump");
  }
}

void Referee::check_values(const ToolPose& hand, const ProxyAnswer& answer) {
  const double away = distance_between(tool_, answer.proxy, hand);
  if (!(away < 1e3) || !answer.pull.allFinite() || !answer.twist.allFinite()) {
    return blame(tally_.inconsistent, "a value that is not finite");
  }
  if (answer.state == ProxyStatus::kFree && away > kRounding) {
    blame(tally_.inconsistent, in_mm("FREE, but away from the hand by", away));
  }
  if (answer.state == ProxyStatus::kFree && answer.pull.norm() > kRounding) {
    blame(tally_.inconsistent, in_mm("FREE, but with a pull of", answer.pull.norm()));
  }
  if (tool_.freedom != ProxyFreedom::kTrocar) return;
  const Vector3d pull = answer.proxy.axis.tip - hand.axis.tip;
  if ((pull - answer.pull).norm() > kRounding) {
    blame(tally_.inconsistent, in_mm("the pull is wrong by", (pull - answer.pull).norm()));
  }
  const double trocar = (answer.proxy.axis.trocar - hand.axis.trocar).norm();
  if (trocar > kRounding) blame(tally_.inconsistent, in_mm("the trocar is wrong by", trocar));
}

/// Checks the distance of some parts of the tool, which have the same clearance [m]. Returns how
/// far they are beyond it, divided by the precision. It is exact up to 2.
double Referee::check_distance(const std::vector<PlacedCore>& parts, const Organ& organ,
                               double clearance, ProxyStatus state) {
  const double distance = organ.oracle.distance(parts, clearance + 2.0 * precision(clearance));
  const double beyond = (distance - clearance) / precision(clearance);
  if (state == ProxyStatus::kSqueezed) {
    tally_.least_squeezed = std::min(tally_.least_squeezed, distance);
    return beyond;
  }
  tally_.least = std::min(tally_.least, distance);
  if (distance < 0.5 * clearance - kRounding) blame(tally_.near, in_mm("too near:", distance));
  return beyond;
}

/// The same for the whole tool.
double Referee::check_distances(const ProxyOrgan& of, const Organ& organ,
                                const ProxyAnswer& answer) {
  const ToolPose pose = of.T_organ_proxy * answer.proxy;
  if (of.clearances.empty()) {
    return check_distance(placed_cores(tool_.radius, tool_.links, pose), organ, settings_.clearance,
                          answer.state);
  }
  double beyond = std::numeric_limits<double>::infinity();
  for (std::size_t part = tool_.radius > 0.0 ? 0 : 1; part < of.clearances.size(); ++part) {
    if (of.clearances[part] == 0.0) continue;
    ToolPose of_part{pose.axis, {}, {}};
    if (part > 0) of_part.links = {pose.links[part - 1]};
    const auto cores = part == 0 ? placed_cores(tool_.radius, {}, of_part)
                                 : placed_cores(0.0, {tool_.links[part - 1]}, of_part);
    beyond = std::min(beyond, check_distance(cores, organ, of.clearances[part], answer.state));
  }
  return beyond;
}

/// The tool without the parts that an organ does not hold.
ProxyTool Referee::held_by(const ProxyOrgan& organ) const {
  ProxyTool held = tool_;
  for (std::size_t part = 0; part < organ.clearances.size(); ++part) {
    if (organ.clearances[part] > 0.0) continue;
    part == 0 ? void(held.radius = 0.0) : held.links[part - 1].parts.clear();
  }
  return held;
}

void Referee::check_passage(const std::vector<ShaftAxis>& lines, const Organ& organ) {
  const bool holds_trocar = tool_.freedom == ProxyFreedom::kTrocar;
  if (!has_detour(organ.oracle, organ.lines, lines, holds_trocar, random_)) {
    blame(tally_.through, "passed through tissue");
  }
}

/// Where only the hand moves, the proxy can stay where it is, so it cannot be squeezed.
void Referee::check_squeeze(const ToolPose& hand, const std::vector<ProxyOrgan>& organs,
                            const ProxyAnswer& answer) {
  const bool is_squeezed = answer.state == ProxyStatus::kSqueezed;
  const bool rests = std::equal(organs.begin(), organs.end(), last_organs_.begin(),
                                last_organs_.end(), [](const auto& now, const auto& last) {
                                  return now.shape == last.shape &&
                                         now.T_organ_proxy.isApprox(last.T_organ_proxy, 0.0);
                                });
  const bool gives_nothing = tool_.links.empty() && (tool_.freedom == ProxyFreedom::kFree ||
                                                     hand.axis.trocar == last_trocar_);
  if (is_squeezed && !was_squeezed_ && rests && gives_nothing && !answer.is_placed_anew) {
    blame(tally_.inconsistent, "SQUEEZED though only the hand moves");
  }
  last_trocar_ = hand.axis.trocar;
  last_organs_ = organs;
  was_squeezed_ = is_squeezed;
}

/// A proxy may need some ticks to find its way to the hand, but not where the straight way is
/// clear.
void Referee::check_way(const ToolPose& hand, const std::vector<ProxyOrgan>& organs,
                        const ProxyAnswer& answer) {
  if (tally_.ticks % kTicksPerWayCheck != 0 || !tool_.links.empty()) return;
  bool is_clear = answer.state == ProxyStatus::kTouching;
  for (std::size_t i = 0; i < organs.size() && is_clear; ++i) {
    const std::vector<double>& own = organs[i].clearances;
    const ToolPose from = organs[i].T_organ_proxy * answer.proxy;
    const ToolPose to = organs[i].T_organ_proxy * hand;
    is_clear = !organs_[i].oracle.is_passed(
        {{from.axis, to.axis}}, 1.0, 1.0,
        tool_.radius + 2.0 * (own.empty() ? settings_.clearance : own[0]));
  }
  clear_ways_ = is_clear ? clear_ways_ + 1 : 0;
  if (clear_ways_ >= kMostClearWays) {
    blame(tally_.held, "held though the straight way to the hand is clear");
  }
}

void Referee::check_side(const std::vector<ShaftAxis>& lines, const Organ& organ) {
  for (const ShaftAxis& line : lines) {
    if (organ.oracle.winding(line.tip) != 0 || organ.oracle.winding(line.trocar) != 0) {
      return blame(tally_.inside, "inside a closed organ");
    }
  }
}

void Referee::check(const ToolPose& hand, bool jumped, const std::vector<ProxyOrgan>& organs,
                    const std::vector<bool>& is_closed, const ProxyAnswer& answer) {
  organs_.resize(organs.size());
  for (std::size_t i = 0; i < organs.size(); ++i) organs_[i].oracle.set_shape(organs[i].shape);
  count_state(jumped, answer);
  if (answer.state == ProxyStatus::kNoAnswer) {
    for (Organ& organ : organs_) organ.lines.clear();
    return;
  }
  check_values(hand, answer);
  double beyond = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < organs.size(); ++i) {
    const ToolPose pose = organs[i].T_organ_proxy * answer.proxy;
    const std::vector<ShaftAxis> lines = skeleton(held_by(organs[i]), pose);
    beyond = std::min(beyond, check_distances(organs[i], organs_[i], answer));
    if (!answer.is_placed_anew && !organs_[i].lines.empty()) check_passage(lines, organs_[i]);
    if (is_closed[i] && (answer.is_placed_anew || tally_.ticks % kTicksPerSideCheck == 0)) {
      check_side(lines, organs_[i]);
    }
    organs_[i].lines = lines;
  }
  if (answer.state == ProxyStatus::kTouching && std::abs(beyond) <= 1.0) ++tally_.at_clearance;
  check_squeeze(hand, organs, answer);
  check_way(hand, organs, answer);
}

}  // namespace organ_collision::oracle
