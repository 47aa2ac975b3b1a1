#pragma once

#include <cmath>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace organ_collision::oracle {

/// What proxies did, and which promises they broke.
struct ProxyTally {
  long ticks = 0;
  long touching = 0;      ///< TOUCHING
  long squeezed = 0;      ///< SQUEEZED
  long jumps = 0;         ///< of the hand
  long overrun = 0;       ///< placed anew because tissue moved through the proxy
  long no_answer = 0;     ///< NO_ANSWER
  long near = 0;          ///< nearer than half the clearance, but not SQUEEZED
  long through = 0;       ///< no way leads around the tissue that a middle line met
  long inside = 0;        ///< a middle line begins or ends inside a closed organ
  long held = 0;          ///< longer than needed: the straight way to the hand was free for a while
  long inconsistent = 0;  ///< FREE but not at the hand, or values that contradict each other
  double least = INFINITY;           ///< [m] the smallest distance up to the clearance
  double least_squeezed = INFINITY;  ///< [m] the same, where SQUEEZED
  std::vector<float> seconds;        ///< of processor time that each tick took

  long broken() const {
    return overrun + no_answer + near + through + inside + held + inconsistent;
  }
  void add(const ProxyTally& other);
};

/// Prints the head of a table, and one line of it, in Markdown.
void print_proxy_head(std::ostream& out);
void print(const std::string& name, ProxyTally tally, std::ostream& out);

/// One random scene with a proxy of its own.
struct Episode {
  std::string kind;  ///< of the scene
  unsigned long seed;
  long number;  ///< Each number of a seed is another scene.
};

/// Follows a hand for so many ticks. `report` receives a tick and what went wrong in it.
ProxyTally follow_hand(const Episode& episode, long ticks,
                       const std::function<void(long, const std::string&)>& report);

}  // namespace organ_collision::oracle
