#pragma once

#include <cstddef>
#include <vector>

#include "organ_surface.hpp"
#include "volume_query.hpp"

namespace organ_collision::bench {

/// A query and its reference answer.
struct CheckedQuery {
  VolumeQuery query;
  Answer answer;
};

/// One step of the simulation: the organ's new shape and the motion of the tool.
struct SceneStep {
  std::size_t shape;          ///< index into Scene::shapes
  CheckedQuery static_query;  ///< the tool at the end of the step
  CheckedQuery swept_query;   ///< the tool from the start of the step to its end
};

/// Number of steps of a scene with this number of faces.
std::size_t step_count(std::size_t faces);

/// A deforming organ and a moving tool, the same in each run. The tool's radius and all motion
/// within a step are in proportion to the length of the faces' edges (see SceneScale), so each
/// query hits 5 to 25 faces at every size of the mesh (0 to 3 of the tetrahedron).
struct Scene {
  /// `faces`: as for make_organ().
  explicit Scene(std::size_t faces);
  /// The same scene with vertices and faces in random order.
  Scene shuffled() const;

  OrganSurface organ;                  ///< at rest
  std::vector<SharedVertices> shapes;  ///< vertices [m] of all shapes, which follow each other
  std::vector<SceneStep> steps;
  std::vector<SceneStep> rigid_steps;  ///< the same motions, all against the first shape
};

}  // namespace organ_collision::bench
