#include "proxy_scene.hpp"

#include <organ_collision/ContactArray.h>

#include <algorithm>

#include "geometry/concatenate.hpp"
#include "haptic_proxy_parameters.hpp"
#include "organ_collision/ros/names.hpp"
#include "ros/messages/text.hpp"
#include "ros/steps/contact_array.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// How long ago the last transform of a frame may have come.
struct FrameLimit {
  double seconds;
  const char* parameter;  ///< the name of the parameter with this limit
};

FrameLimit frame_limit(const AgeLimits& limits) {
  const FrameLimit of_meshes{limits.mesh_sec, names::kMeshTimeoutSec};
  const FrameLimit of_frames{limits.frame_sec, names::kFrameTimeoutSec};
  if (of_frames.seconds == 0.0) return of_meshes;
  const bool is_first = of_meshes.seconds > 0.0 && of_meshes.seconds < of_frames.seconds;
  return is_first ? of_meshes : of_frames;
}

/// The organ's name for a proxy. When its sender restarts, the organ gets another name, and is
/// therefore another organ: it does not carry the proxy from the old shape to the new one.
std::string name_of_history(const DeformableOrgan& organ) {
  return organ.histories() == 0 ? organ.name() : concatenate(organ.name(), " ", organ.histories());
}

/// [s] The interval over which the velocity of an organ's frame is measured.
constexpr double kFrameInterval = 0.01;
/// [1] A shape moves until the next one comes, but for at most so many times the time between the
/// last two shapes.
constexpr double kLongestMotion = 2.0;

}  // namespace

std::pair<std::shared_ptr<const TriangleMesh>, TissueMotion> latest_shape(
    const DeformableOrgan& organ, ros::Time now) {
  const OrganShape &latest = organ.latest(), &previous = organ.previous();
  if (!previous.mesh) return {latest.mesh, {}};
  const bool have_stamps = !latest.stamp.isZero() && !previous.stamp.isZero();
  const double before = (have_stamps ? previous.stamp : previous.received).toSec();
  const double seconds = (have_stamps ? latest.stamp : latest.received).toSec() - before;
  if (!(seconds > 0.0) || latest.age(now) > kLongestMotion * seconds) return {latest.mesh, {}};
  return {latest.mesh, {previous.mesh, latest.mesh, seconds}};
}

Vector3d tissue_velocity(const ProxyScene& scene, std::size_t organ, const FaceContact& contact) {
  const ProxyOrgan& now = scene.organs[organ];
  const TissueMotion& motion = scene.motions[organ];
  Vector3d velocity = Vector3d::Zero();
  if (motion.shape_before) {
    const Vector3d way = point_at(motion.shape_after->triangle(contact.face), contact.barycentric) -
                         point_at(motion.shape_before->triangle(contact.face), contact.barycentric);
    velocity += now.T_organ_proxy.linear().transpose() * way / motion.shape_sec;
  }
  if (motion.T_before) {
    const Vector3d before = motion.T_before->inverse() * (now.T_organ_proxy * contact.point);
    velocity += (contact.point - before) / motion.frame_sec;
  }
  return velocity;
}

bool ProxyFrame::update(const OrganRegistry& organs) {
  const auto& all = organs.organs();
  if (fixed_ || all.empty()) return false;
  const bool is_used = std::any_of(
      all.begin(), all.end(), [this](const auto& organ) { return organ.second.frame() == name_; });
  if (is_used) return false;
  name_ = all.begin()->second.frame();
  return true;
}

Rejection no_organ() {
  return {ContactArray::NO_MESH, "no organ", "there is no organ; send one on organ_mesh"};
}

ProxyScene proxy_scene(const OrganRegistry& organs, const TransformBuffer& transforms,
                       const std::string& frame, const AgeLimits& limits, ros::Time now,
                       const ShapeOf& shape_of) {
  if (organs.organs().empty()) throw no_organ();
  ProxyScene scene{frame, {}, {}};
  for (const auto& [name, organ] : organs.organs()) {
    if (is_stale(organ.latest(), now, limits.mesh_sec)) {
      throw Rejection(ContactArray::STALE_MESH, reason_of(ContactArray::STALE_MESH),
                      stale_message(name, organ.latest(), now, limits.mesh_sec));
    }
    const auto T_organ_proxy = look_up(transforms, organ.frame(), frame, ros::Time(0));
    if (!T_organ_proxy.found) {
      throw Rejection(ContactArray::NO_TRANSFORM, reason_of(ContactArray::NO_TRANSFORM),
                      "organ '" + name + "': " + T_organ_proxy.why_not);
    }
    check_age(transforms, organ.frame(), {frame}, limits, now);
    check_age(transforms, frame, {organ.frame()}, limits, now);
    scene.stamps.push_back(T_organ_proxy.found->stamp);
    auto [shape, motion] = shape_of(organ);
    scene.organs.push_back({name_of_history(organ), std::move(shape), organ.latest().topology(),
                            T_organ_proxy.found->value});
    scene.sources.push_back(&organ);
    if (T_organ_proxy.found->stamp.toSec() > kFrameInterval) {
      const ros::Time before = T_organ_proxy.found->stamp - ros::Duration(kFrameInterval);
      const auto T_before = look_up(transforms, organ.frame(), frame, before);
      if (T_before.found) motion.T_before = T_before.found->value;
      motion.frame_sec = kFrameInterval;
    }
    scene.motions.push_back(std::move(motion));
  }
  return scene;
}

void check_age(const TransformBuffer& transforms, const std::string& frame,
               const TransformBuffer::Frames& others, const AgeLimits& limits, ros::Time now) {
  const FrameLimit limit = frame_limit(limits);
  if (!(limit.seconds > 0.0)) return;
  const auto last = transforms.oldest_transform(frame, others);
  if (!last) return;
  const double age = now.toSec() - last->received.toSec();
  if (!(age > limit.seconds)) return;
  throw Rejection(
      ContactArray::STALE_MESH, "stale frame",
      concatenate("the last transform of frame '", last->frame, "' came ", duration_text(age),
                  " ago; at most ", limit.seconds, " s are allowed (", limit.parameter, ")"));
}

}  // namespace organ_collision
