#include <nodelet/loader.h>
#include <pthread.h>
#include <ros/ros.h>

#include <cstdlib>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "echo.hpp"
#include "simulator.hpp"

namespace {

using organ_collision::bench::Echo;
using organ_collision::bench::print;
using organ_collision::bench::Simulator;

/// Gives the calling thread realtime priority.
void set_priority(int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  if (pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) != 0) {
    throw std::runtime_error("the system refuses realtime priority");
  }
}

/// Does what a line of standard input asks for.
void obey(const std::string& line, Simulator& simulator) {
  std::istringstream words(line);
  std::string what;
  words >> what;
  if (double rate = 0.0, seconds = 0.0; what == "shapes" && words >> rate >> seconds) {
    print("shapes", simulator.run(rate, seconds));
  } else if (what == "service" && words >> seconds) {
    print("service", simulator.ask(seconds));
  } else if (int priority = 0; what == "priority" && words >> priority) {
    set_priority(priority);
    std::cout << "{}" << std::endl;
  } else {
    throw std::runtime_error("what is '" + line + "'?");
  }
}

}  // namespace

// end_to_end external|nodelet|echo FACES TOOLS
// Measures the node organ_collision of its own namespace, which is already running (external), or
// the nodelet or an Echo in this process. When it gets answers, it prints an empty line. Then it
// reads what to measure from standard input and prints a line of JSON for each line that it reads:
//   shapes RATE SECONDS   the latencies from shapes to contacts, the shapes being sent at RATE [Hz]
//   service SECONDS       the latencies of service calls
//   priority PRIORITY     {}; from now on, the simulator's thread has this realtime priority
int main(int argc, char** argv) {
  ros::init(argc, argv, "end_to_end");
  if (argc != 4) return std::cerr << "end_to_end external|nodelet|echo FACES TOOLS" << std::endl, 2;
  const std::string what = argv[1];
  const std::size_t faces = std::strtoul(argv[2], nullptr, 10);
  const std::size_t tools = std::strtoul(argv[3], nullptr, 10);
  const ros::NodeHandle node;
  try {
    std::unique_ptr<nodelet::Loader> loader;
    std::optional<Echo> echo;
    if (what == "echo") echo.emplace(tools);
    if (what == "nodelet") {
      loader = std::make_unique<nodelet::Loader>(false);
      const std::string name = ros::names::resolve("organ_collision");
      if (!loader->load(name, "organ_collision/CollisionNodelet", {}, {})) return 1;
    }
    Simulator simulator(faces, tools);
    simulator.start();
    std::cout << std::endl;
    for (std::string line; std::getline(std::cin, line) && ros::ok();) obey(line, simulator);
  } catch (const std::exception& error) {
    std::cerr << "end_to_end: " << error.what() << std::endl;
    return 1;
  }
}
