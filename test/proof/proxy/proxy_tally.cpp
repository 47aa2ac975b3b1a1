#include "proxy_tally.hpp"

#include <algorithm>
#include <iomanip>
#include <ostream>

namespace organ_collision::oracle {
namespace {

/// The time below which this share of the ticks is [us]. Reorders them.
double quantile(std::vector<float>& seconds, double share) {
  if (seconds.empty()) return 0.0;
  const auto last = static_cast<double>(seconds.size() - 1);
  const auto place = seconds.begin() + static_cast<std::ptrdiff_t>(share * last);
  std::nth_element(seconds.begin(), place, seconds.end());
  return 1e6 * static_cast<double>(*place);
}

double percent(long part, long all) {
  return all > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(all) : 0.0;
}

}  // namespace

void ProxyTally::add(const ProxyTally& other) {
  ticks += other.ticks;
  touching += other.touching;
  squeezed += other.squeezed;
  jumps += other.jumps;
  overrun += other.overrun;
  no_answer += other.no_answer;
  near += other.near;
  through += other.through;
  inside += other.inside;
  held += other.held;
  inconsistent += other.inconsistent;
  least = std::min(least, other.least);
  least_squeezed = std::min(least_squeezed, other.least_squeezed);
  seconds.insert(seconds.end(), other.seconds.begin(), other.seconds.end());
}

void print_proxy_head(std::ostream& out) {
  out << "| scene | ticks | touching | squeezed | jumps | overrun | no answer | too near | through "
         "| inside | held | inconsistent | least distance [mm] | where squeezed [mm] | median [us] "
         "| 99 % "
         "| 99.9 % | most "
         "|\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
}

void print(const std::string& name, ProxyTally tally, std::ostream& out) {
  out << "| " << name << " | " << tally.ticks << std::fixed << std::setprecision(1) << " | "
      << percent(tally.touching, tally.ticks) << " % | " << std::setprecision(3)
      << percent(tally.squeezed, tally.ticks) << " %";
  for (const long count : {tally.jumps, tally.overrun, tally.no_answer, tally.near, tally.through,
                           tally.inside, tally.held, tally.inconsistent}) {
    out << " | " << count;
  }
  out << std::setprecision(4) << " | " << 1e3 * tally.least << " | ";
  if (tally.squeezed > 0) out << 1e3 * tally.least_squeezed;
  out << std::setprecision(0);
  for (const double share : {0.5, 0.99, 0.999, 1.0}) {
    out << " | " << quantile(tally.seconds, share);
  }
  out << " |" << std::defaultfloat << std::endl;
}

}  // namespace organ_collision::oracle
