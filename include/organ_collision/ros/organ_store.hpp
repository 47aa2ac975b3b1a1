#pragma once

#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <ros/time.h>

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>

#include "organ_collision/ros/organ.hpp"
#include "organ_collision/ros/rejection.hpp"

namespace organ_collision {

/// What a message did to an organ.
enum class OrganChange {
  kShape,   ///< it has a new shape
  kFrame,   ///< it has a new shape, in another frame: nothing known before compares to it
  kRemoved  ///< it is gone
};

/// All organs by name, as the accepted messages made them. A refused message changes nothing.
class OrganStore {
 public:
  explicit OrganStore(const MeshLimits& limits) : limits_(limits) {}

  /// The surface of a mesh message. Throws MeshError. May be called from any thread.
  TriangleMesh make(const OrganMeshConstPtr& message) const;

  /// Throw Rejection. The message's vertices become the organ's shape as they are, without a copy;
  /// the message lives as long as that shape is needed. `made` gives what `make` would, asked only
  /// where the triangles are new.
  OrganChange apply(const OrganMeshConstPtr& message, ros::Time now,
                    const std::function<TriangleMesh()>& made);
  OrganChange apply(const OrganMeshConstPtr& message, ros::Time now) {
    return apply(message, now, [&] { return make(message); });
  }
  OrganChange apply(const OrganVerticesConstPtr& message, ros::Time now);
  /// Whether the organ has triangles of that topology.
  bool has_topology(const std::string& organ, std::uint32_t topology) const;

  /// Throws Rejection: UNKNOWN_ORGAN, or NO_MESH for one that was removed or never sent validly.
  const Organ& at(const std::string& name) const;
  const std::map<std::string, Organ>& organs() const { return organs_; }

  /// Each organ keeps its latest shape only.
  void forget_previous_shapes();

 private:
  OrganChange apply_checked(const OrganMeshConstPtr& message, const std::string& frame,
                            ros::Time now, const std::function<TriangleMesh()>& made);
  std::string known_organs() const;

  MeshLimits limits_;
  std::map<std::string, Organ> organs_;
  std::set<std::string> without_mesh_;  ///< heard of, but removed or never valid
};

}  // namespace organ_collision
