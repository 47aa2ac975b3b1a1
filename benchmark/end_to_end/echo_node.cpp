#include <ros/ros.h>

#include <cstdlib>
#include <iostream>

#include "echo.hpp"

// echo_node TOOLS: runs an Echo in its own process.
int main(int argc, char** argv) {
  ros::init(argc, argv, "organ_collision");
  if (argc != 2) return std::cerr << "echo_node TOOLS" << std::endl, 2;
  const organ_collision::bench::Echo echo(std::strtoul(argv[1], nullptr, 10));
  ros::waitForShutdown();
}
