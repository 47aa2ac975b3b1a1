#include "latency_report.hpp"

#include <iostream>

namespace organ_collision::bench {

void print(const char* what, const LatencyReport& report) {
  constexpr double kMicro = 1e6;
  std::cout << "{\"what\": \"" << what << "\", \"rate\": " << report.rate
            << ", \"sent\": " << report.sent << ", \"skipped\": " << report.skipped
            << ", \"failed\": " << report.failed
            << ", \"median\": " << kMicro * report.latencies.quantile(0.5)
            << ", \"p99\": " << kMicro * report.latencies.quantile(0.99)
            << ", \"worst\": " << kMicro * report.latencies.quantile(1.0) << "}" << std::endl;
}

}  // namespace organ_collision::bench
