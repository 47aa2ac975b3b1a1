#pragma once

#include <cstddef>
#include <vector>

#include "benchmark/engines/volume_query.hpp"
#include "oracle.hpp"
#include "organ_surface.hpp"

namespace organ_collision::bench {

/// A question and the right answer.
struct CheckedQuery {
  VolumeQuery query;
  Answer answer;
};

/// One step of the simulation: the organ's new shape, and where the tool is and was.
struct SceneStep {
  std::size_t shape;   ///< of the scene
  CheckedQuery fixed;  ///< the static query: the tool at the end of the step
  CheckedQuery swept;  ///< from its start to its end
};

/// How many steps a scene of so many faces has.
std::size_t step_count(std::size_t faces);

/// An organ that deforms and a tool that moves, the same at each run. All that moves within a step
/// is in proportion to the length of the faces' edges, and so is the tool's radius: at every size
/// of the mesh 5 to 25 faces are hit (of a tetrahedron 0 to 3).
struct Scene {
  explicit Scene(std::size_t faces);
  /// The same with the vertices and the faces in random order.
  Scene shuffled() const;

  OrganSurface organ;                  ///< at rest
  std::vector<SharedVertices> shapes;  ///< vertices, one after the other in a circle
  std::vector<SceneStep> steps;
  std::vector<SceneStep> rigid_steps;  ///< the same motions, all against the first shape
};

}  // namespace organ_collision::bench
