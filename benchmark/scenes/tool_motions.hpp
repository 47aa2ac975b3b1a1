#pragma once

#include <random>

#include "organ_collision/geometry/tool/shaft.hpp"
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

}  // namespace organ_collision::bench
