#pragma once

#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <ros/time.h>

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>

#include "connection.hpp"
#include "deformable_organ.hpp"
#include "ros/interface/rejection.hpp"

namespace organ_collision {

/// What a message did to an organ.
enum class OrganChange {
  kShape,   ///< it has a new shape
  kFrame,   ///< it has a new shape, in another frame: nothing known before compares to it
  kOrgan,   ///< it is another organ of that name: nothing known before compares to it
  kRemoved  ///< it is gone
};

/// All organs by name, as the accepted messages made them. A refused message changes nothing.
class OrganRegistry {
 public:
  explicit OrganRegistry(const MeshLimits& limits) : limits_(limits) {}

  /// The surface of a mesh message. Throws MeshError. May be called from any thread.
  TriangleMesh make(const OrganMeshConstPtr& message) const;

  /// Throw Rejection. The message's vertices become the organ's shape as they are, without a copy;
  /// the message lives as long as that shape is needed. `made` gives what `make` would, asked only
  /// where the triangles are new. New triangles under the number that the organ has are another
  /// organ where they come over a connection that is new to it, as from a simulator that was
  /// restarted, and are refused over any other.
  OrganChange apply(const OrganMeshConstPtr& message, const Connection& connection, ros::Time now,
                    const std::function<TriangleMesh()>& made);
  OrganChange apply(const OrganMeshConstPtr& message, ros::Time now) {
    return apply(message, {}, now, [&] { return make(message); });
  }
  OrganChange apply(const OrganVerticesConstPtr& message, ros::Time now);
  /// Whether `apply` would ask for `made`.
  bool is_new(const OrganMesh& message, const Connection& connection) const;
  /// All connections are new again: the next mesh of each organ may be another organ.
  void forget_connections() { connections_.clear(); }

  /// Throws Rejection: UNKNOWN_ORGAN, or NO_MESH for one that was removed or never sent validly.
  const DeformableOrgan& at(const std::string& name) const;
  const std::map<std::string, DeformableOrgan>& organs() const { return organs_; }

  /// Each organ keeps its latest shape only.
  void forget_previous_shapes();

 private:
  OrganChange apply_checked(const OrganMeshConstPtr& message, const Connection& connection,
                            const std::string& frame, ros::Time now,
                            const std::function<TriangleMesh()>& made);
  bool is_another_organ(const DeformableOrgan& organ, const OrganMesh& message,
                        const Connection& connection) const;
  std::string known_organs() const;

  MeshLimits limits_;
  std::map<std::string, DeformableOrgan> organs_;
  std::map<std::string, ConnectionSet> connections_;  ///< by organ: over which its meshes came
  std::set<std::string> without_mesh_;                ///< heard of, but removed or never valid
};

}  // namespace organ_collision
