// The programs of run_soak: `soak simulator SEED`, `soak judge SEED`, and `soak check`, which tests
// the second evaluation of the judge.
#include <gtest/gtest.h>
#include <ros/init.h>

#include <cstdlib>
#include <iostream>
#include <string>

#include "soak.hpp"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  const std::string role = argc > 1 ? argv[1] : "";
  if (role == "check") return RUN_ALL_TESTS();
  ros::init(argc, argv, "soak_" + role);
  if (argc == 3 && role == "simulator") {
    return organ_collision::soak::simulate(std::strtoull(argv[2], nullptr, 10));
  }
  if (argc == 3 && role == "judge") {
    return organ_collision::soak::judge(std::strtoull(argv[2], nullptr, 10));
  }
  std::cerr << "Usage: soak simulator|judge SEED, or: soak check\n";
  return 2;
}
