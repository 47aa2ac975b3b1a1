#pragma once

#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <ros/time.h>

#include <functional>
#include <map>
#include <set>
#include <string>

#include "common/messages/conversions.hpp"
#include "common/messages/failure_log.hpp"
#include "common/messages/senders.hpp"
#include "deformable_organ.hpp"

namespace organ_collision {

/// What a message changed. After kFrame, kOrgan and kSender, the new shape cannot be compared with
/// earlier shapes of this organ.
enum class OrganChange {
  kShape,   ///< the organ has a new shape
  kFrame,   ///< the organ has a new shape in another frame
  kOrgan,   ///< another organ has taken the name
  kSender,  ///< the organ's sender has restarted; triangles and frame may also be new
  kRemoved  ///< the organ is gone
};

/// Whether a mesh message says that its organ is gone: it has neither vertices nor triangles.
bool is_removal(const OrganMesh& mesh);

/// All known organs by name. A message that is refused changes no organ.
class OrganRegistry {
 public:
  /// Refuses meshes above `limits`, and stamps that `ahead` refuses, which must outlive this.
  OrganRegistry(const MeshLimits& limits, const AheadLimit& ahead)
      : limits_(limits), ahead_(&ahead) {}

  using Build = std::function<TriangleMesh()>;

  /// Builds the surface that a mesh message describes. Throws MeshError. Any thread may call it.
  TriangleMesh build(const OrganMeshConstPtr& message) const;

  /// These functions apply a message. They throw Rejection. The vertices become the organ's shape
  /// without a copy: the message lives as long as that shape is used. `built` is called in place of
  /// build(message) if the triangles are new.
  ///
  /// A mesh may have other triangles under the topology number that the organ already has. If the
  /// mesh came over a connection that is new to this organ, for example from a restarted simulator,
  /// it is another organ. Over a known connection, such a mesh is refused.
  ///
  /// A sender has restarted if a shape comes over another connection than the last shape of the
  /// same organ and type of message, and that connection is closed. If that connection is still
  /// open, a warning says that the organ has two senders.
  OrganChange apply(const OrganMeshConstPtr& message, ros::Time now,
                    const Connection& connection = {}, const Build& built = {});
  OrganChange apply(const OrganVerticesConstPtr& message, ros::Time now,
                    const Connection& connection = {});
  /// Whether `apply` would call `built` for this message.
  bool is_new(const OrganMesh& message, const Connection& connection) const;

  /// Throws Rejection: UNKNOWN_ORGAN, or NO_MESH if the organ was removed or if all its meshes were
  /// refused. The message of NO_MESH says which of the two, and why the last mesh was refused.
  const DeformableOrgan& at(const std::string& name) const;
  const std::map<std::string, DeformableOrgan>& organs() const { return organs_; }

  /// Why the organ's last mesh was refused. Empty if the mesh was accepted, or if none came.
  std::string last_refusal(const std::string& organ) const;

  /// Another history of each organ begins at `now`. Each keeps only its latest shape. Shapes that
  /// were received later count as received now, so that they can become stale. All connections
  /// count as new, so that the next mesh of a name may be another organ.
  void begin_histories(const std::string& why, ros::Time now);

 private:
  OrganChange set_shape(const OrganMeshConstPtr& message, const Connection& connection,
                        const std::string& frame, ros::Time now, const Build& built);
  bool note_sender(DeformableOrgan& organ, Senders::Stream stream, const Connection& connection,
                   ros::Time now);
  /// A number that no history has had.
  History next_history(const std::string& why) { return {++histories_, why}; }
  void check_stamp(ros::Time stamp, ros::Time now, const std::string& named) const;

  MeshLimits limits_;
  const AheadLimit* ahead_;
  std::map<std::string, DeformableOrgan> organs_;
  std::uint64_t histories_ = 0;  ///< how many histories of organs have begun
  std::map<std::string, std::set<Connection>> connections_;  ///< each organ's mesh connections
  std::map<std::string, Senders> senders_;                   ///< by organ
  /// For each organ, why its last mesh was refused; empty if the organ was removed. An accepted
  /// mesh removes the entry.
  std::map<std::string, std::string> refusals_;
};

}  // namespace organ_collision
