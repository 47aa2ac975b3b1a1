#pragma once

#include <ros/time.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/messages/failure_log.hpp"
#include "node/motion/transform_buffer.hpp"
#include "node/organs/organ_registry.hpp"
#include "organ_collision/query/haptic_proxy.hpp"

namespace organ_collision {

/// The TF frame in which proxies move.
class ProxyFrame {
 public:
  /// `fixed`: the name of the frame. If it is empty, update() chooses the frame of an organ.
  explicit ProxyFrame(std::string fixed) : fixed_(!fixed.empty()), name_(std::move(fixed)) {}

  /// Empty: there was no organ yet.
  const std::string& name() const { return name_; }

  /// Chooses the first organ's frame, if none is fixed. The chosen frame stays while any organ has
  /// it, and also if no organ is left. Returns whether the frame changed.
  bool update(const OrganRegistry& organs);

 private:
  bool fixed_;
  std::string name_;
};

/// How an organ moves, from its last two shapes and from TF.
struct TissueMotion {
  /// The latest shape, and OrganShape::moves_from(). Null: the shape rests.
  std::shared_ptr<const TriangleMesh> shape_before = nullptr, shape_after = nullptr;
  double shape_sec = 0.0;      ///< [s] between both shapes
  ros::Time stamp = {};        ///< of the shape that the organ has in the scene
  double lag_sec = 0.0;        ///< [s] how old this shape is; 0 if the organ does not change shape
  double frame_lag_sec = 0.0;  ///< [s] how old the pose of the organ's frame is; 0 if it rests
  std::optional<Eigen::Isometry3d> T_before = {};  ///< T_organ_proxy kVelocitySec ago; empty: rests
};

/// All organs as one tick of a proxy takes them.
struct ProxyScene {
  std::string frame;  ///< the proxy's frame
  std::vector<ProxyOrgan> organs;
  std::vector<const DeformableOrgan*> sources;  ///< where `organs` come from, in the same order
  /// The stamps of the organs' poses, in the same order; zero if an organ's frame is static.
  std::vector<ros::Time> stamps = {};
  std::vector<TissueMotion> motions = {};  ///< of the organs, in the same order
};

/// The velocity [m/s] of an organ's tissue at a point of a face, in the proxy's frame. `contact`:
/// of the organ number `organ` of the scene, in the proxy's frame.
Eigen::Vector3d tissue_velocity(const ProxyScene& scene, std::size_t organ,
                                const FaceContact& contact);

/// Tells a proxy how an organ of the scene moves. `guards_lag`: sets ProxyOrgan::advance, the speed
/// at which the tissue comes towards the tool times the lag of its shape and of its frame.
/// `tells_rows`: sets ProxyOrgan::approach. Both refer to the scene.
void tell_motion(const ProxyScene& scene, std::size_t organ, bool guards_lag, bool tells_rows,
                 ProxyOrgan& told);

/// What tissue does to a proxy that it holds: the mean over all places that bear a load, along
/// these loads and weighted by them. In the proxy's frame, at the centre or the tip of the tool.
struct TissuePush {
  Eigen::Vector3d way = Eigen::Vector3d::Zero();       ///< [m] since the organs were as before
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s]
};

/// `before`: the organs at the tick before; of new organs and triangles, there is no way.
/// `has_levers`: a place of the shaft moves the tip more than itself, as by a lever about the
/// trocar.
TissuePush tissue_push(const ProxyScene& scene, const std::vector<ProxyOrgan>& before,
                       const ProxyAnswer& answer, bool has_levers);

/// The longest time since something of an organ came [s of ROS time]. 0 means no limit.
struct AgeLimits {
  double mesh_sec = 0.0;   ///< of their shapes, and of their frames
  double frame_sec = 0.0;  ///< of their frames, unless these are static
};

/// The reason that is given if there is no organ.
Rejection no_organ();

/// The shape of an organ in a tick, with its stamp.
using ShapeOf = std::function<Timed<std::shared_ptr<const TriangleMesh>>(const DeformableOrgan&)>;

/// The organs with the shapes that `shape_of` tells, at their poses in `frame` at the time `at`. If
/// `at` is zero or this pose is not known, the latest pose counts. They are valid as long as the
/// registry does not change. Throws Rejection if there is no organ, if an organ has no transform to
/// the frame, or if its shape or a transform came longer ago than allowed.
ProxyScene proxy_scene(const OrganRegistry& organs, const TransformBuffer& transforms,
                       const std::string& frame, const AgeLimits& limits, ros::Time now,
                       const ShapeOf& shape_of, ros::Time at = {});

/// Throws Rejection if the last transform of a frame in the chain from `frame` upwards came longer
/// ago than allowed. The chain ends below the first frame that also carries all of `others`: what
/// is above moves both sides together. Static transforms have no age. The node's own clock counts,
/// and not the stamps, because the clocks of senders differ.
void check_age(const TransformBuffer& transforms, const std::string& frame,
               const TransformBuffer::Frames& others, const AgeLimits& limits, ros::Time now);

}  // namespace organ_collision
