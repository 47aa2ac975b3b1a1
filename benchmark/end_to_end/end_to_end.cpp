#include <nodelet/loader.h>
#include <ros/ros.h>

#include <cstdlib>
#include <iostream>
#include <memory>
#include <optional>

#include "echo.hpp"
#include "simulator.hpp"

namespace {

using organ_collision::bench::Echo;
using organ_collision::bench::LatencyReport;
using organ_collision::bench::print;
using organ_collision::bench::Simulator;

/// The highest of several rates that the node sustains for a second without skipping a shape [Hz].
/// 10 Hz if it sustains no other.
double sustained_rate(Simulator& simulator) {
  for (const double rate : {1000.0, 500.0, 250.0, 100.0, 50.0, 25.0}) {
    const LatencyReport trial = simulator.run(rate, 1.0);
    if (!trial.late && trial.skipped == 0 && trial.failed == 0) return rate;
  }
  return 10.0;
}

}  // namespace

// end_to_end external|nodelet|echo FACES TOOLS SECONDS
// Measures /organ_collision, which is already running (external), or the nodelet or an Echo in this
// process. Prints lines of JSON: "settling" after the node has received some shapes, "shapes" with
// the latencies from shapes to contacts, and "service" with those of service calls, if there is
// such a service.
int main(int argc, char** argv) {
  ros::init(argc, argv, "end_to_end");
  if (argc != 5) {
    return std::cerr << "end_to_end external|nodelet|echo FACES TOOLS SECONDS" << std::endl, 2;
  }
  const std::string what = argv[1];
  const std::size_t faces = std::strtoul(argv[2], nullptr, 10);
  const std::size_t tools = std::strtoul(argv[3], nullptr, 10);
  const double seconds = std::atof(argv[4]);
  const ros::NodeHandle node;
  try {
    std::unique_ptr<nodelet::Loader> loader;
    std::optional<Echo> echo;
    if (what == "echo") echo.emplace(tools);
    if (what == "nodelet") {
      loader = std::make_unique<nodelet::Loader>(false);
      if (!loader->load("/organ_collision", "organ_collision/CollisionNodelet", {}, {})) return 1;
    }
    Simulator simulator(faces, tools);
    simulator.start();
    // The caller reads the node's memory when this line arrives. Later rates may be too high for
    // the node. Waiting messages would then take memory, too.
    print("settling", simulator.run(20.0, 1.0));
    const double rate = sustained_rate(simulator);
    print("shapes", simulator.run(rate, seconds));
    if (ros::service::exists("/organ_collision/query", false)) {
      print("service", simulator.ask(seconds));
    }
  } catch (const std::exception& error) {
    std::cerr << "end_to_end: " << error.what() << std::endl;
    return 1;
  }
}
