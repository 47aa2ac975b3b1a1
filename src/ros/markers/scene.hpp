#pragma once

#include <organ_collision/ContactArray.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"
#include "organ_collision/query/haptic_proxy.hpp"
#include "ros/parameters/node_parameters.hpp"
#include "ros/steps/step_history.hpp"
#include "ros/tools/tool.hpp"

namespace organ_collision {

/// An organ and its latest shape, which nobody changes.
struct SceneOrgan {
  std::string name;
  std::string frame;
  std::shared_ptr<const TriangleMesh> mesh;

  /// [m] The diagonal of its box. Widths of lines and heights of texts are shares of it.
  double size() const { return mesh->box().diagonal().cast<double>().norm(); }
};

/// What is known of a tool and an organ.
struct ScenePair {
  std::string organ;
  std::size_t tool;              ///< index into Scene::tools
  ContactArrayConstPtr answer;   ///< the latest about the organ's present triangles; null: none yet
  std::optional<ToolPose> pose;  ///< in the organ's frame, at the last successful step
};

/// A step since the last picture.
struct SceneStep {
  SteadyTime time;
  ContactArrayConstPtr answer;
  SharedFaces faces;  ///< of the organ at that time
  ToolPath path;      ///< empty if the step failed
  double query_sec;
};

/// A hand and its proxy.
struct ProxyView {
  Tool tool;
  std::string frame;             ///< the proxy's frame
  std::optional<ToolPose> hand;  ///< in this frame; not set: it is not known
  ProxyAnswer answer;            ///< to this hand
  double force = 0.0;            ///< [N] the magnitude of the force on the hand
  double size = 0.1;             ///< [m] of the scene: widths and heights of texts are shares of it
};

/// What one picture shows. It shares or copies everything, so that another thread can draw it.
struct Scene {
  SteadyTime time;
  MarkerSettings settings;
  bool anew = false;  ///< a subscriber has come that knows nothing yet
  std::shared_ptr<const std::vector<Tool>> tools;
  std::vector<SceneOrgan> organs;
  std::vector<ScenePair> pairs;  ///< sorted by organ, then tool
  std::vector<SceneStep> steps;  ///< the oldest first
  std::vector<ProxyView> proxies;

  /// Null if there is no such organ.
  const SceneOrgan* organ(const std::string& name) const {
    for (const SceneOrgan& organ : organs) {
      if (organ.name == name) return &organ;
    }
    return nullptr;
  }
  /// The first pair of the tool that has a pose: the tool is drawn in the frame of that organ. Null
  /// if there is none.
  const ScenePair* placement(std::size_t tool) const {
    for (const ScenePair& pair : pairs) {
      if (pair.tool == tool && pair.pose && organ(pair.organ)) return &pair;
    }
    return nullptr;
  }
};

}  // namespace organ_collision
