/// Prints what a hand feels that stabs through tissue and comes back: by contact_adapter's penalty
/// law, and by a haptic proxy. The figure stab_forces of doc/haptics.md shows these rows, which are
/// kept in doc/figures/stab_forces.csv.

#include <cmath>
#include <cstdio>
#include <memory>

#include "common/messages/conversions.hpp"
#include "contact_adapter/force_law.hpp"
#include "demo/liver.hpp"
#include "organ_collision/query/haptic_proxy.hpp"
#include "test/contact_adapter/force_trajectory.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

constexpr double kShaftRadius = 0.003;    // [m]
constexpr double kHandStiffness = 300.0;  // [N/m] the default of both nodes
constexpr double kTick = 0.001;           // [s]
constexpr int kTicks = 200;               // for the way in and back

/// A hand that moves its tip from `start` to `end` and back. The tissue rests.
struct Stab {
  const char* name;
  std::shared_ptr<const TriangleMesh> tissue;
  Vector3d trocar, start, end;  ///< [m]

  /// [m] from the start
  double way(int tick) const {
    return (end - start).norm() * std::pow(std::sin(M_PI * tick / kTicks), 2);
  }
  Vector3d direction() const { return (end - start).normalized(); }
  ShaftAxis hand(int tick) const { return {trocar, start + way(tick) * direction()}; }
};

/// A shaft comes down on a sheet from its side, so that it can be wholly below it.
Stab through_a_sheet() {
  const auto place = [](double u, double v) -> Vector3d {
    return {0.06 * u - 0.03, 0.1 * v - 0.05, 0.0};
  };
  const auto sheet = std::make_shared<TriangleMesh>(grid_mesh(8, 12, place));
  return {"sheet", sheet, {-0.1, 0.002, 0.01}, {0.02, 0.003, 0.012}, {0.02, 0.003, -0.03}};
}

/// The stab of the demo through the left lobe of its liver, which is 36 mm thick there.
Stab through_a_lobe() {
  const ClosedSurface liver = make_liver_surface();
  std::vector<float> vertices;
  std::vector<std::uint32_t> triangles;
  for (const Vector3d& vertex : liver.vertices) {
    for (const double x : vertex) vertices.push_back(static_cast<float>(x));
  }
  for (const FaceIndices& face : liver.faces) {
    triangles.insert(triangles.end(), face.begin(), face.end());
  }
  const auto lobe = std::make_shared<TriangleMesh>(vertices, triangles);
  return {"lobe", lobe, {0.095, -0.130, 0.040}, {0.068, 0.030, 0.030}, {0.068, 0.030, -0.040}};
}

/// [N] The forces of the penalty law, one for each tick.
std::vector<Vector3d> penalty_forces_of(const Stab& stab) {
  std::vector<ToolWaypoint> hands;
  for (int tick = 0; tick <= kTicks; ++tick) hands.push_back({0.0, stab.hand(tick)});
  CollisionRequest request;
  request.organ = stab.tissue.get();
  request.radius = kShaftRadius;
  const ForceOf law = [law = ForceLaw()](const ContactArray& answer) mutable {
    return to_eigen(wrench_of(law.follow(answer, kTick, kHandStiffness, kShaftRadius)).force);
  };
  std::vector<Vector3d> forces;
  for (const ForceStep& step : forces_along(hands, request, law)) {
    forces.push_back(step.force);
  }
  return forces;
}

/// [N] The forces of the spring between hand and proxy, one for each tick.
std::vector<Vector3d> proxy_forces_of(const Stab& stab) {
  HapticProxy proxy({kShaftRadius}, ProxySettings());
  std::vector<Vector3d> forces;
  for (int tick = 0; tick <= kTicks; ++tick) {
    const ProxyAnswer& answer = proxy.follow({stab.hand(tick)}, {{"tissue", stab.tissue}});
    forces.push_back(kHandStiffness * answer.pull);
  }
  return forces;
}

/// [N] The part of a force that acts against the stab, without a sign if it is zero.
double against(const Stab& stab, const Vector3d& force) {
  return std::round(-1e3 * stab.direction().dot(force)) / 1e3 + 0.0;
}

void print(const Stab& stab) {
  const auto penalty = penalty_forces_of(stab), proxy = proxy_forces_of(stab);
  for (int tick = 0; tick <= kTicks; ++tick) {
    std::printf("%s,%d,%.2f,%.3f,%.3f\n", stab.name, tick, 1e3 * stab.way(tick),
                against(stab, penalty[tick]), against(stab, proxy[tick]));
  }
}

}  // namespace
}  // namespace organ_collision

int main() {
  std::printf("tissue,time_ms,way_mm,penalty_n,proxy_n\n");
  organ_collision::print(organ_collision::through_a_sheet());
  organ_collision::print(organ_collision::through_a_lobe());
}
