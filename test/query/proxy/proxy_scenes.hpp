#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "organ_collision/query/haptic_proxy.hpp"
#include "test/closed_surfaces.hpp"
#include "test/proof/trials.hpp"

/// Tools, hands and surfaces for the tests of the haptic proxy. Organs rest around the origin, and
/// tools come from above.
namespace organ_collision {

constexpr double kToolRadius = 3e-3;                           // [m]
const double kStop = kToolRadius + ProxySettings().clearance;  // [m] from the axis to the tissue

inline ProxyTool shaft_tool() { return {kToolRadius, {}, ProxyFreedom::kTrocar}; }
inline ProxyTool ball_tool() { return {kToolRadius, {}, ProxyFreedom::kFree}; }

/// The hand of a tool through a trocar above the origin.
inline ToolPose shaft_hand(const Eigen::Vector3d& tip) {
  return {{Eigen::Vector3d(0.0, 0.0, 0.3), tip}};
}
/// The hand of a ball.
inline ToolPose ball_hand(const Eigen::Vector3d& center) { return {{center, center}}; }

inline ToolPose hand_of(const ProxyTool& tool, const Eigen::Vector3d& tip) {
  return tool.freedom == ProxyFreedom::kTrocar ? shaft_hand(tip) : ball_hand(tip);
}

inline ProxyOrgan organ_of(const GridSurface& surface, const std::string& name = "organ") {
  ProxyOrgan organ;
  organ.name = name;
  organ.shape = std::make_shared<TriangleMesh>(surface.vertices, surface.triangles());
  return organ;
}

/// A surface z(x, y) over the square from -0.1 to 0.1 m, with 2 * side * side faces.
template <typename Height>
GridSurface height_field(int side, const Height& height) {
  GridSurface surface = grid_surface(side);
  for (std::size_t i = 0; i < surface.vertices.size(); i += 3) {
    float* const at = &surface.vertices[i];
    at[2] = static_cast<float>(height(at[0], at[1]));
  }
  return surface;
}

inline GridSurface flat_sheet(int side, double z = 0.0) {
  return height_field(side, [z](double, double) { return z; });
}

/// Moves the hand straight at `speed` [m/s], a tick a millisecond, and returns the last answer.
/// `visit(hand, answer)` is called at each tick.
template <typename Visit>
const ProxyAnswer* move_hand(HapticProxy& proxy, const ProxyTool& tool, Eigen::Vector3d& tip,
                             const Eigen::Vector3d& to, double speed,
                             const std::vector<ProxyOrgan>& organs, const Visit& visit) {
  const Eigen::Vector3d from = tip;
  const int ticks = static_cast<int>(std::ceil((to - from).norm() / (1e-3 * speed)));
  const ProxyAnswer* answer = nullptr;
  for (int i = 1; i <= ticks; ++i) {
    tip = from + static_cast<double>(i) / ticks * (to - from);
    answer = &proxy.follow(hand_of(tool, tip), organs);
    visit(tip, *answer);
  }
  return answer;
}

/// \overload
inline const ProxyAnswer* move_hand(HapticProxy& proxy, const ProxyTool& tool, Eigen::Vector3d& tip,
                                    const Eigen::Vector3d& to, double speed,
                                    const std::vector<ProxyOrgan>& organs) {
  return move_hand(proxy, tool, tip, to, speed, organs,
                   [](const Eigen::Vector3d&, const ProxyAnswer&) {});
}

/// A test of a shaft through a trocar and of a ball.
class ProxyWith : public testing::TestWithParam<ProxyFreedom> {
 protected:
  const ProxyTool tool_ = GetParam() == ProxyFreedom::kTrocar ? shaft_tool() : ball_tool();
};

}  // namespace organ_collision
