#include "episode.hpp"

#include <ctime>
#include <vector>

#include "referee.hpp"
#include "scenes.hpp"

namespace organ_collision::oracle {
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
