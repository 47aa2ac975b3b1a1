#include "episode.hpp"

#include <chrono>
#include <vector>

#include "referee.hpp"
#include "scenes.hpp"

namespace organ_collision::oracle {

ProxyTally follow_hand(const Episode& episode, long ticks,
                       const std::function<void(long, const std::string&)>& report) {
  using Clock = std::chrono::steady_clock;
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
    const Clock::time_point begin = Clock::now();
    const ProxyAnswer& answer = proxy.follow(pose, organs);
    seconds.push_back(std::chrono::duration<float>(Clock::now() - begin).count());
    referee.check(pose, hand.jumped(), organs, is_closed, answer);
  }
  ProxyTally tally = referee.tally();
  tally.seconds = std::move(seconds);
  return tally;
}

}  // namespace organ_collision::oracle
