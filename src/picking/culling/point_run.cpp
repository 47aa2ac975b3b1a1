#include "point_run.hpp"

namespace organ_collision {
namespace {

ValueRun between(const ValueRun& before, const ValueRun& after, float fraction) {
  ValueRun run;
  for (std::size_t i = 0; i < run.size(); ++i) {
    run[i] = before[i] + fraction * (after[i] - before[i]);
  }
  return run;
}

Lanes magnitude(const Lanes& low, const Lanes& high) { return high > -low ? high : -low; }

}  // namespace

PointRun between(const PointRun& before, const PointRun& after, float fraction) {
  return {between(before.x, after.x, fraction), between(before.y, after.y, fraction),
          between(before.z, after.z, fraction)};
}

ValueRun magnitude(const BoxRun& boxes) {
  const auto& [low, high] = boxes;
  ValueRun sum;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    sum[i] = magnitude(low.x[i], high.x[i]) + magnitude(low.y[i], high.y[i]) +
             magnitude(low.z[i], high.z[i]);
  }
  return sum;
}

ValueRun greater(const ValueRun& a, const ValueRun& b) {
  ValueRun run;
  for (std::size_t i = 0; i < run.size(); ++i) run[i] = a[i] > b[i] ? a[i] : b[i];
  return run;
}

ValueRun scaled(const ValueRun& values, float factor) {
  ValueRun run;
  for (std::size_t i = 0; i < run.size(); ++i) run[i] = factor * values[i];
  return run;
}

}  // namespace organ_collision
