#pragma once

#include <random>

#include "organ_collision/geometry/tool/shaft.hpp"
#include "organ_surface.hpp"

namespace organ_collision::bench {

/// How thick the tool is and what moves within a step [m]: in proportion to the length of the
/// edges, so that a query hits about as many faces at each size of the mesh.
struct Sizes {
  explicit Sizes(std::size_t faces);

  double radius;      ///< 5 mm at 1224 faces and fewer
  double tip_step;    ///< from the start of a step to its end
  double organ_step;  ///< radius of the circle on which each vertex goes round
};

/// Moves a tool, the same way at each run: through one of four trocars above the organ into a face
/// that looks towards it, and sideways by a step.
class Surgeon {
 public:
  /// `organ` outlives the surgeon.
  Surgeon(const OrganSurface& organ, const Sizes& sizes) : organ_(organ), sizes_(sizes) {}

  /// The next step, against the organ's present `vertices`.
  ShaftMotion motion(const std::vector<float>& vertices);

 private:
  double either_side(double distance) { return random_() % 2 == 0 ? distance : -distance; }
  Eigen::Vector3d any_vector();

  const OrganSurface& organ_;
  Sizes sizes_;
  std::mt19937 random_{1999};
};

}  // namespace organ_collision::bench
