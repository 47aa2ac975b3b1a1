#include <nodelet/loader.h>
#include <ros/ros.h>

#include <cstdlib>
#include <iostream>
#include <memory>

#include "simulator.hpp"

namespace {

using organ_collision::bench::LatencyReport;
using organ_collision::bench::Simulator;

void print(const char* what, const LatencyReport& report) {
  constexpr double kMicro = 1e6;
  std::cout << "{\"what\": \"" << what << "\", \"rate\": " << report.rate
            << ", \"sent\": " << report.sent << ", \"skipped\": " << report.skipped
            << ", \"failed\": " << report.failed
            << ", \"median\": " << kMicro * report.latencies.quantile(0.5)
            << ", \"p99\": " << kMicro * report.latencies.quantile(0.99)
            << ", \"worst\": " << kMicro * report.latencies.quantile(1.0) << "}" << std::endl;
}

/// The highest rate at which no shape is skipped for a second.
double sustained_rate(Simulator& simulator) {
  for (const double rate : {1000.0, 500.0, 250.0, 100.0, 50.0, 25.0}) {
    const LatencyReport trial = simulator.run(rate, 1.0);
    if (trial.skipped == 0 && trial.failed == 0) return rate;
  }
  return 10.0;
}

}  // namespace

// end_to_end node|nodelet FACES TOOLS SECONDS: the node runs as /organ_collision, or is loaded into
// this process. A line of JSON when it has settled, one for shapes to contacts, one for service
// calls.
int main(int argc, char** argv) {
  ros::init(argc, argv, "end_to_end");
  if (argc != 5) return std::cerr << "end_to_end node|nodelet FACES TOOLS SECONDS" << std::endl, 2;
  const bool in_process = std::string(argv[1]) == "nodelet";
  const double seconds = std::atof(argv[4]);
  const ros::NodeHandle node;
  try {
    std::unique_ptr<nodelet::Loader> loader;
    if (in_process) {
      loader = std::make_unique<nodelet::Loader>(false);
      if (!loader->load("/organ_collision", "organ_collision/CollisionNodelet", {}, {})) return 1;
    }
    Simulator simulator(std::strtoul(argv[2], nullptr, 10), std::strtoul(argv[3], nullptr, 10));
    simulator.start();
    // The caller looks at the node's memory when this line comes: later rates may be too high, and
    // what waits then takes memory as well.
    print("settling", simulator.run(20.0, 1.0));
    const double rate = sustained_rate(simulator);
    print("shapes", simulator.run(rate, seconds));
    print("service", simulator.ask(seconds));
  } catch (const std::exception& error) {
    std::cerr << "end_to_end: " << error.what() << std::endl;
    return 1;
  }
}
