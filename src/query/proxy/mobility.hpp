#pragma once

#include <Eigen/Geometry>
#include <memory>

#include "least_constraint.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"
#include "organ_collision/query/contact.hpp"
#include "organ_collision/query/haptic_proxy.hpp"

namespace organ_collision {

/// In which ways a proxy can move, and what the hand prescribes. The hand prescribes the joints of
/// the tool and its trocar. The rest of a pose is free: three or six coordinates, in metres.
class Mobility {
 public:
  virtual ~Mobility() = default;

  /// The pose with the free coordinates of `free` and all else as the hand prescribes.
  virtual ToolPose combine(const ToolPose& free, const ToolPose& hand) const = 0;
  /// The motion from one pose to another that agrees with it in all that the hand prescribes.
  virtual Displacement between(const ToolPose& from, const ToolPose& to) const = 0;
  /// The pose after a motion. All but the free coordinates is taken from the hand.
  virtual ToolPose moved(const ToolPose& pose, const Displacement& displacement,
                         const ToolPose& hand) const = 0;
  /// The row by which a small displacement moves the place of a contact along its normal: row ·
  /// displacement [m].
  virtual Displacement row(const ToolPose& pose, const FaceContact& contact) const = 0;
  /// [m] No point of the tool moves farther than this.
  virtual double longest_way(const ToolPose& pose, const Displacement& displacement) const = 0;
  /// Where the pull on the hand acts [m].
  virtual Eigen::Vector3d center(const ToolPose& pose) const = 0;
  /// [m] How a rotation compares with a translation; 0 if there is no free rotation.
  virtual double size() const { return 0.0; }
  /// Prepares for the pose of the hand at a tick: `size()` and `center()` may depend on its joints.
  virtual void measure(const ToolPose&) {}
};

/// For a tool. It refers to the tool, which must outlive it.
std::unique_ptr<Mobility> make_mobility(const ProxyTool& tool);

/// The pose at a time in [0, 1] of a motion, as ToolPath says.
ToolPose interpolate(const ToolPose& from, const ToolPose& to, double time);

}  // namespace organ_collision
