// The simulator of run_soak. It begins when a node listens, and prints an empty line. At the line
// "end" on standard input, it ends calmly, and prints as JSON what it has sent. It stays until
// standard input is closed, so that nothing of it is lost on the way.
#include <ros/init.h>
#include <ros/spinner.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <string>
#include <thread>

#include "simulator.hpp"

namespace {

using namespace organ_collision::soak;
using namespace std::chrono_literals;
using SteadyClock = std::chrono::steady_clock;

constexpr auto kTick = 1ms;  ///< of wall time
/// A simulator that is late by more than this does not make up for it.
constexpr auto kLatest = 10ms;
/// [ticks] If the node is farther behind, the simulator waits for it, but not longer than this.
/// With a flood, the node's queues of 1000 poses then do not overflow.
constexpr std::uint64_t kMostLag = 500;
constexpr auto kLongestWait = 5s;
constexpr int kCalmTicks = 40;
constexpr auto kCalmTick = 50ms;
constexpr auto kStart = 60s;

template <typename Condition>
bool wait_for(const Condition& condition) {
  const auto give_up = SteadyClock::now() + kStart;
  while (!condition()) {
    if (SteadyClock::now() > give_up) return false;
    std::this_thread::sleep_for(20ms);
  }
  return true;
}

void wait_for_node(const Simulator& simulator, std::uint64_t most_lag,
                   SteadyClock::duration longest) {
  const auto give_up = SteadyClock::now() + longest;
  while (simulator.lag() > most_lag && SteadyClock::now() < give_up) {
    std::this_thread::sleep_for(kTick);
  }
}

void print(const Sent& sent) {
  std::cout << "{\"ticks\": " << sent.ticks << ", \"meshes\": " << sent.meshes
            << ", \"vertices\": " << sent.vertices << ", \"jumps\": " << sent.jumps
            << ", \"floods\": " << sent.floods << ", \"cuts\": " << sent.cuts
            << ", \"ticks without poses\": " << sent.gap_ticks
            << ", \"glitches\": " << sent.glitches << "}" << std::endl;
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "simulator");
  if (argc != 2) {
    std::cerr << "Usage: soak_simulator SEED\n";
    return 2;
  }
  Simulator simulator(std::strtoull(argv[1], nullptr, 10));
  if (!wait_for([&] { return simulator.has_listener(); })) {
    std::cerr << "soak_simulator: no node listens\n";
    return 1;
  }
  ros::AsyncSpinner spinner(1);
  spinner.start();
  simulator.send_scene();
  if (!wait_for([&] { return simulator.scene_has_come(); })) {
    std::cerr << "soak_simulator: the node does not know the organ\n";
    return 1;
  }
  // The node counts losses from the first message that it gets. It must be the first one of all.
  simulator.calm_tick();
  wait_for_node(simulator, 0, kStart);
  std::cout << std::endl;

  std::atomic<bool> ends = false;
  std::string line;
  std::thread input([&] {
    std::getline(std::cin, line);
    ends = true;
  });
  auto next = SteadyClock::now();
  while (!ends) {
    simulator.tick();
    wait_for_node(simulator, kMostLag, kLongestWait);
    next += kTick;
    if (SteadyClock::now() > next + kLatest) next = SteadyClock::now();
    std::this_thread::sleep_until(next);
  }
  input.join();
  for (int i = 0; i < kCalmTicks; ++i) {
    simulator.calm_tick();
    std::this_thread::sleep_for(kCalmTick);
  }
  print(simulator.sent());
  std::getline(std::cin, line);
  return 0;
}
