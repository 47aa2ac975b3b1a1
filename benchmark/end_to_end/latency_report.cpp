#include "latency_report.hpp"

#include <iostream>

namespace organ_collision::bench {

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
