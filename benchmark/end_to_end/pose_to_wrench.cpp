#include <nodelet/loader.h>
#include <ros/ros.h>

#include <cstdlib>
#include <iostream>
#include <memory>
#include <optional>

#include "echo.hpp"
#include "hand.hpp"

// pose_to_wrench external|nodelet|echo FACES SECONDS
// Measures the node haptic_proxy of its own namespace, which is already running (external), or the
// nodelet or an Echo in this process. Prints a line of JSON: "poses" with the latencies from poses
// to wrenches.
int main(int argc, char** argv) {
  using namespace organ_collision::bench;
  ros::init(argc, argv, "pose_to_wrench");
  if (argc != 4) {
    return std::cerr << "pose_to_wrench external|nodelet|echo FACES SECONDS" << std::endl, 2;
  }
  const std::string what = argv[1];
  const ros::NodeHandle node;
  try {
    std::unique_ptr<nodelet::Loader> loader;
    std::optional<Echo> echo;
    if (what == "echo") echo.emplace(1);
    if (what == "nodelet") {
      loader = std::make_unique<nodelet::Loader>(false);
      const std::string name = ros::names::resolve("haptic_proxy");
      if (!loader->load(name, "organ_collision/haptic_proxy", {}, {})) return 1;
    }
    Hand hand(std::strtoul(argv[2], nullptr, 10));
    hand.start();
    hand.run(1.0);
    print("poses", hand.run(std::atof(argv[3])));
  } catch (const std::exception& error) {
    std::cerr << "pose_to_wrench: " << error.what() << std::endl;
    return 1;
  }
}
