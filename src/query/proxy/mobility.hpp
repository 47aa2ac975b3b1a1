#pragma once

#include <memory>

#include "least_constraint.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"
#include "organ_collision/query/contact.hpp"
#include "organ_collision/query/haptic_proxy.hpp"

namespace organ_collision {

/// In which ways a proxy can move. The hand prescribes the joints of the tool and its trocar. The
/// rest of a pose is free: three or six coordinates in metres (doc/theory/geometry.md, Haptic
/// proxy).
class Mobility {
 public:
  virtual ~Mobility() = default;

  /// The pose with the free coordinates of `free`, and with the joints and the trocar of `hand`.
  ToolPose combine(const ToolPose& free, const ToolPose& hand) const {
    return moved(free, Displacement::Zero(), hand);
  }
  /// The change of the free coordinates from one pose to another.
  virtual Displacement between(const ToolPose& from, const ToolPose& to) const = 0;
  /// The pose after a motion, with the joints and the trocar of `hand`.
  virtual ToolPose moved(const ToolPose& pose, const Displacement& displacement,
                         const ToolPose& hand) const = 0;
  /// The row of a contact's wall. A small displacement moves the tool at the contact by row ·
  /// displacement [m] along the contact's normal.
  virtual Displacement row(const ToolPose& pose, const FaceContact& contact) const = 0;
  /// [m] No point of the tool moves farther than this in the motion.
  virtual double longest_way(const ToolPose& pose, const Displacement& displacement) const = 0;
  /// The point of the tool on which the spring between hand and proxy acts [m].
  virtual Eigen::Vector3d center(const ToolPose& pose) const = 0;
  /// [m] A rotation by an angle [rad] counts as much as a translation by this length times the
  /// angle. 0 if the tool cannot rotate freely.
  virtual double size() const { return 0.0; }
  /// Prepares for the pose of the hand at a tick: `size()` and `center()` may depend on its joints.
  virtual void measure(const ToolPose&) {}
};

/// The mobility of a tool. The tool must outlive it.
std::unique_ptr<Mobility> make_mobility(const ProxyTool& tool);

}  // namespace organ_collision
