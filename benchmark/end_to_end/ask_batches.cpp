#include <organ_collision/ContactArray.h>
#include <ros/ros.h>

#include <cstdlib>
#include <iostream>
#include <sstream>
#include <stdexcept>

#include "batch_client.hpp"

namespace {

using organ_collision::ContactArray;
using organ_collision::bench::BatchClient;

void obey(const std::string& line, BatchClient& client) {
  std::istringstream words(line);
  std::string what;
  words >> what;
  if (what == "organ") {
    client.publish_organ();
    std::cout << "{}" << std::endl;
    return;
  }
  std::size_t count = 0;
  double seconds = 0.0;
  if ((what != "static" && what != "swept") || !(words >> count >> seconds)) {
    throw std::runtime_error("what is '" + line + "'?");
  }
  const auto mode = what == "static" ? ContactArray::STATIC : ContactArray::SWEPT;
  const BatchClient::Report report = client.ask(mode, count, seconds);
  std::cout << "{\"motions\": " << report.motions << ", \"contacts\": " << report.contacts
            << ", \"failed\": " << report.failed << ", \"seconds\": " << report.seconds << "}"
            << std::endl;
}

}  // namespace

// ask_batches FACES shaft|grasper
// Reads what to ask the node organ_collision of its own namespace from standard input, and prints a
// line of JSON for each line that it reads:
//   organ                       {}; publishes the organ. Not needed if a simulator does
//   static|swept COUNT SECONDS  batches of COUNT motions, until SECONDS have passed
int main(int argc, char** argv) {
  ros::init(argc, argv, "ask_batches");
  if (argc != 3) return std::cerr << "ask_batches FACES shaft|grasper" << std::endl, 2;
  const ros::NodeHandle node;
  try {
    BatchClient client(std::strtoul(argv[1], nullptr, 10), argv[2]);
    for (std::string line; std::getline(std::cin, line) && ros::ok();) obey(line, client);
  } catch (const std::exception& error) {
    std::cerr << "ask_batches: " << error.what() << std::endl;
    return 1;
  }
}
