#pragma once

#include <cstddef>
#include <random>
#include <vector>

#include "organ_collision/geometry/tool/link.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"
#include "organ_collision/query/haptic_proxy.hpp"
#include "organ_surface.hpp"

namespace organ_collision::bench {

/// The tool's radius and how far things move within a step [m]. All are in proportion to the length
/// of the faces' edges, so a query touches about as many faces at each size of the mesh.
struct SceneScale {
  explicit SceneScale(std::size_t faces);

  double radius;      ///< of the tool; 5 mm at 1224 faces and fewer
  double tip_step;    ///< distance that the tip moves from the start of a step to its end
  double organ_step;  ///< amplitude of the motion of each vertex, see deformed()
};

/// A seeded sequence of tool motions. In each, the tool enters through one of four trocars above
/// the organ, pierces a face that looks towards the trocar, and moves sideways by
/// SceneScale::tip_step.
class ToolMotions {
 public:
  /// `organ` must outlive this object.
  ToolMotions(const OrganSurface& organ, const SceneScale& scale) : organ_(organ), scale_(scale) {}

  /// The next motion, against the organ in the shape given by `vertices` (x y z x y z ... [m]).
  ShaftMotion next(const std::vector<float>& vertices);

 private:
  double either_side(double distance) { return random_() % 2 == 0 ? distance : -distance; }
  Eigen::Vector3d any_vector();

  const OrganSurface& organ_;
  SceneScale scale_;
  std::mt19937 random_{1999};
};

/// Independent motions of one tool, as a planner asks about them. Each path has two waypoints.
struct MotionSet {
  double radius;            ///< [m] of the tool's shaft
  std::vector<Link> links;  ///< of the tool; empty if it is only a shaft
  std::vector<ToolPath> paths;
};

/// The Grasper, of the same size for each organ. Its shaft ends above the organ, and its jaws reach
/// into it. In a motion it moves sideways by 1 mm, and each jaw closes by 0.02 rad.
MotionSet grasper_motions(const OrganSurface& organ, std::size_t count);

/// One lap of a hand, a pose for each tick of 1 ms. The hand goes around a circle of 8 cm diameter,
/// seen from above, at 0.25 to 0.3 m/s. Its shaft goes through a trocar above the organ, and its
/// tip stays `depth` [m] below the top of a WavingOrgan's middle shape.
std::vector<ToolPose> sliding_lap(double depth);

/// The number of poses of a lap: a multiple of WavingOrgan::kPeriod, so that a lap repeats itself.
constexpr std::size_t kLap = 1000;

}  // namespace organ_collision::bench
