#include "episode.hpp"

#include <algorithm>
#include <ctime>
#include <iomanip>
#include <ostream>

#include "referee.hpp"
#include "scenes.hpp"

namespace organ_collision::oracle {
namespace {

/// The time below which this share of the ticks is [us]. Reorders them.
double quantile(std::vector<float>& seconds, double share) {
  if (seconds.empty()) return 0.0;
  const auto last = static_cast<double>(seconds.size() - 1);
  const auto place = seconds.begin() + static_cast<std::ptrdiff_t>(share * last);
  std::nth_element(seconds.begin(), place, seconds.end());
  return 1e6 * static_cast<double>(*place);
}

double percent(long part, long all) {
  return all > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(all) : 0.0;
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
  least = std::min(least, other.least);
  least_squeezed = std::min(least_squeezed, other.least_squeezed);
  seconds.insert(seconds.end(), other.seconds.begin(), other.seconds.end());
}

void print_proxy_head(std::ostream& out) {
  out << "| scene | ticks | touching | squeezed | jumps | overrun | no answer | too near | through "
         "| inside | held | inconsistent | least distance [mm] | where squeezed [mm] | median [us] "
         "| 99 % "
         "| 99.9 % | most "
         "|\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
}

void print(const std::string& name, ProxyTally tally, std::ostream& out) {
  out << "| " << name << " | " << tally.ticks << std::fixed << std::setprecision(1) << " | "
      << percent(tally.touching, tally.ticks) << " % | " << std::setprecision(3)
      << percent(tally.squeezed, tally.ticks) << " %";
  for (const long count : {tally.jumps, tally.overrun, tally.no_answer, tally.near, tally.through,
                           tally.inside, tally.held, tally.inconsistent}) {
    out << " | " << count;
  }
  out << std::setprecision(4) << " | " << 1e3 * tally.least << " | ";
  if (tally.squeezed > 0) out << 1e3 * tally.least_squeezed;
  out << std::setprecision(0);
  for (const double share : {0.5, 0.99, 0.999, 1.0}) {
    out << " | " << quantile(tally.seconds, share);
  }
  out << " |" << std::defaultfloat << std::endl;
}

namespace {

/// What this thread has computed for. Other programs on the machine do not matter.
double processor_seconds() {
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

ProxyTally follow_hand(const Episode& episode, long ticks,
                       const std::function<void(long, const std::string&)>& report) {
  Random random(1000003 * episode.seed + static_cast<unsigned long>(episode.number));
  ProxyScene scene = make_proxy_scene(episode.kind, random);
  ScriptedHand hand(scene.hand, random);
  HapticProxy proxy(scene.hand.tool, scene.settings);
  long tick = 0;
  Referee referee(scene.hand.tool, scene.settings,
                  [&](const std::string& what) { report(tick, what); });
  std::vector<bool> is_closed;
  for (const ScriptedOrgan& organ : scene.organs) is_closed.push_back(organ.is_closed());
  std::vector<float> seconds;
  for (; tick < ticks; ++tick) {
    const ToolPose& pose = hand.next();
    std::vector<ProxyOrgan> organs;
    for (ScriptedOrgan& organ : scene.organs) organs.push_back(organ.at(tick));
    const double begin = processor_seconds();
    const ProxyAnswer& answer = proxy.follow(pose, organs);
    seconds.push_back(static_cast<float>(processor_seconds() - begin));
    referee.check(pose, hand.jumped(), organs, is_closed, answer);
  }
  ProxyTally tally = referee.tally();
  tally.seconds = std::move(seconds);
  return tally;
}

}  // namespace organ_collision::oracle
