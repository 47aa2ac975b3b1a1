#include "latency_report.hpp"

#include <ros/init.h>

#include <iostream>

namespace organ_collision::bench {

void answer_until(ros::Time time, ros::CallbackQueue& queue) {
  for (ros::Time now = ros::Time::now(); now < time && ros::ok(); now = ros::Time::now()) {
    queue.callOne(ros::WallDuration((time - now).toSec()));
  }
}

void print(const char* what, const LatencyReport& report) {
  constexpr double kMicro = 1e6;
  std::cout << "{\"what\": \"" << what << "\", \"rate\": " << report.rate
            << ", \"sent\": " << report.sent << ", \"skipped\": " << report.skipped
            << ", \"failed\": " << report.failed
            << ", \"late\": " << (report.late ? "true" : "false")
            << ", \"query\": " << kMicro * report.query_sec << ", \"latencies\": [";
  const char* separator = "";
  for (const double latency : report.latencies.all()) {
    std::cout << separator << kMicro * latency;
    separator = ", ";
  }
  std::cout << "]}" << std::endl;
}

}  // namespace organ_collision::bench
