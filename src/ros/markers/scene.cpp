#include "scene.hpp"

#include <algorithm>

namespace organ_collision {

SceneOrgan scene_organ(const DeformableOrgan& organ) {
  const TriangleMesh& mesh = *organ.latest().mesh;
  return {organ.name(), organ.frame(), mesh.shared_vertices(), mesh.shared_faces(), mesh.box()};
}

const SceneOrgan* Scene::organ(const std::string& name) const {
  const auto found = std::find_if(organs.begin(), organs.end(),
                                  [&](const SceneOrgan& organ) { return organ.name == name; });
  return found != organs.end() ? &*found : nullptr;
}

const ScenePair* Scene::placement(std::size_t tool) const {
  const auto found = std::find_if(pairs.begin(), pairs.end(), [&](const ScenePair& pair) {
    return pair.tool == tool && pair.pose && organ(pair.organ);
  });
  return found != pairs.end() ? &*found : nullptr;
}

}  // namespace organ_collision
