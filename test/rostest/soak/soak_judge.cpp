// The judge of run_soak. It prints an empty line when the node publishes. At each line on standard
// input, it prints a report as JSON. It ends when standard input is closed.
#include <ros/init.h>
#include <ros/spinner.h>

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <string>
#include <thread>

#include "judge.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, "judge");
  if (argc != 2) {
    std::cerr << "Usage: soak_judge SEED\n";
    return 2;
  }
  organ_collision::soak::Judge judge(std::strtoull(argv[1], nullptr, 10));
  ros::AsyncSpinner spinner(1);
  spinner.start();
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!judge.is_connected()) {
    if (std::chrono::steady_clock::now() > give_up) {
      std::cerr << "soak_judge: no node publishes\n";
      return 1;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  std::cout << std::endl;
  for (std::string line; std::getline(std::cin, line);) judge.report(std::cout);
  return 0;
}
