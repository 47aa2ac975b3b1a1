#include "proxy_tally.hpp"

#include <algorithm>
#include <cstdio>

#include "ros/interface/conversions.hpp"
#include "ros/publishing/markers/proxy_markers.hpp"

namespace organ_collision {
namespace {

template <typename... Values>
std::string shown(const char* format, Values... values) {
  char text[128];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

}  // namespace

void ProxyTally::add(const ProxyState& state) {
  state_ = state.state;
  message_ = state.message;
  if (state.state == ProxyState::NO_ANSWER) return;
  const double force = to_eigen(state.wrench.force).norm();
  ++poses_;
  ++answered_;
  held_ += state.state != ProxyState::FREE;
  force_ = std::max(force_, force);
  greatest_ = std::max(greatest_, force);
  tick_sec_ += state.tick_sec;
}

std::string ProxyTally::take_line(double seconds) {
  std::string line = name_of(static_cast<ProxyStatus>(state_));
  if (state_ == ProxyState::NO_ANSWER) {
    line += ": " + message_;
  } else {
    line += shown(", up to %.1f N, %.0f poses/s", force_, poses_ / seconds);
  }
  poses_ = 0;
  force_ = 0.0;
  return line;
}

std::string ProxyTally::summary() const {
  const double all = std::max<double>(1.0, answered_);
  return shown(
      "%zu poses, tissue held the proxy in %.0f%% of them, with at most %.1f N; %.0f us a "
      "tick on average",
      answered_, 100.0 * held_ / all, greatest_, 1e6 * tick_sec_ / all);
}

}  // namespace organ_collision
