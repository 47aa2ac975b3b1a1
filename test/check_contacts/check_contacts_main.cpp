#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "check_options.hpp"
#include "contact_watch.hpp"

/// check_contacts: watches topics of contacts for answers that break their contract.

namespace organ_collision {
namespace {

constexpr int kNothingFound = 0, kFound = 1, kIllegalOption = 2, kNoAnswer = 3;

int watch(const CheckOptions& options) {
  const ros::NodeHandle node, private_node("~");
  const ContactWatch watch(node, private_node, options.topics);
  const ros::SteadyTime start = ros::SteadyTime::now();
  while (ros::ok()) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.1));
    const double seconds = (ros::SteadyTime::now() - start).toSec();
    if (options.seconds && seconds >= *options.seconds) break;
  }
  std::cout << "check_contacts: " << watch.summary() << std::endl;
  if (watch.has_found()) return kFound;
  return watch.answers() > 0 ? kNothingFound : kNoAnswer;
}

int run(int argc, char** argv) {
  std::vector<std::string> arguments;
  ros::removeROSArgs(argc, argv, arguments);
  CheckOptions options;
  try {
    options = parse_check_options({arguments.begin() + 1, arguments.end()});
  } catch (const std::invalid_argument& error) {
    std::cerr << "check_contacts: " << error.what() << std::endl;
    return kIllegalOption;
  }
  if (options.help) {
    std::cout << check_usage();
    return kNothingFound;
  }
  ros::init(argc, argv, "check_contacts");
  try {
    return watch(options);
  } catch (const ros::InvalidNameException& error) {
    std::cerr << "check_contacts: " << error.what() << std::endl;
    return kIllegalOption;
  }
}

}  // namespace

}  // namespace organ_collision

int main(int argc, char** argv) { return organ_collision::run(argc, argv); }
