#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "benchmark/engines/fcl_tool.hpp"
#include "benchmark/scenes/motion_set.hpp"
#include "organ_collision/query/collision_query.hpp"

namespace organ_collision::bench {

/// What is compared: engines that tell which faces of an organ at rest a motion touches. All trees
/// are built once.
class MotionEngines {
 public:
  /// Answers one motion and returns the number of faces.
  using Ask = std::function<std::size_t(const ToolPath&)>;

  MotionEngines(const OrganSurface& organ, const MotionSet& motions);

  /// What one thread asks `engine`:
  /// - "static" and "swept": CollisionQuery, all contacts with their full geometry;
  /// - "static_cpu": the same as "static", but without OpenGL;
  /// - "fcl": FCL's static query, the faces with FCL's contacts;
  /// - "fcl_touches": FCL's static query, which ends at the first face; 1 if there is one.
  /// Throws std::invalid_argument for any other.
  Ask asker(const std::string& engine) const;

  /// How far FCL's answers are from this package's, in static queries of the first `count` motions.
  struct Comparison {
    std::size_t faces = 0;          ///< that this package finds
    std::size_t missed_by_fcl = 0;  ///< of these, not in FCL's answer
    std::size_t only_by_fcl = 0;
  };
  Comparison compare(std::size_t count) const;

 private:
  Ask own_asker(QueryMode mode, PickerKind picker) const;
  CollisionRequest request(const ToolPath& path, QueryMode mode) const;

  const MotionSet& motions_;
  TriangleMesh organ_;
  FclTool fcl_;
};

}  // namespace organ_collision::bench
