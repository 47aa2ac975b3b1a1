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

/// How old the newest transform of a frame may be.
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

/// [s] The age of a stamp. It is 0 if the stamp is ahead of the clock, or zero as in static frames.
double age(ros::Time stamp, ros::Time now) {
  return stamp.isZero() ? 0.0 : std::max(0.0, now.toSec() - stamp.toSec());
}

bool is_old(ros::Time stamp, const FrameLimit& limit, ros::Time now) {
  return limit.seconds > 0.0 && age(stamp, now) > limit.seconds;
}

Rejection stale_frame(const NewestTransform& newest, const FrameLimit& limit, ros::Time now) {
  return {ContactArray::STALE_MESH, "stale frame",
          concatenate("the newest transform of frame '", newest.frame, "' is ",
                      duration_text(age(newest.stamp, now)), " old; at most ", limit.seconds,
                      " s are allowed (", limit.parameter, ")")};
}

/// Of the frames between `a` and `b`, the one whose newest transform is the oldest. It is `a` if
/// all of them are static.
std::string oldest_between(const TransformBuffer& transforms, const std::string& a,
                           const std::string& b) {
  const auto of_a = transforms.oldest_transform(a, {b}), of_b = transforms.oldest_transform(b, {a});
  if (of_b && (!of_a || of_b->stamp < of_a->stamp)) return of_b->frame;
  return of_a ? of_a->frame : a;
}

/// [1] The least lever of a place near the trocar.
constexpr double kLeastLever = 0.1;

TissueMotion motion_of(const DeformableOrgan& organ, ros::Time now) {
  const OrganShape& latest = organ.latest();
  return {latest.moves_from(now), latest.mesh, latest.motion_sec};
}

/// [m] How far a point of a face has moved with an organ, in the proxy's frame.
Vector3d way_of(const std::vector<ProxyOrgan>& before, const ProxyOrgan& now, std::uint32_t face,
                const Vector3d& barycentric) {
  const auto then = std::find_if(before.begin(), before.end(),
                                 [&](const auto& organ) { return organ.name == now.name; });
  if (then == before.end() || then->shape->topology() != now.shape->topology() ||
      !then->shape->same_faces(*now.shape)) {
    return Vector3d::Zero();
  }
  const auto place = [&](const ProxyOrgan& organ) -> Vector3d {
    return organ.T_organ_proxy.inverse() * point_at(organ.shape->triangle(face), barycentric);
  };
  return place(now) - place(*then);
}

}  // namespace

Vector3d tissue_velocity(const ProxyScene& scene, std::size_t organ, const FaceContact& contact) {
  const ProxyOrgan& now = scene.organs[organ];
  const TissueMotion& motion = scene.motions[organ];
  Vector3d velocity = Vector3d::Zero();
  if (motion.shape_before) {
    velocity += now.T_organ_proxy.linear().transpose() *
                velocity_between(*motion.shape_before, *motion.shape_after, motion.shape_sec,
                                 contact.face, contact.barycentric);
  }
  if (motion.T_before) {
    const Vector3d before = motion.T_before->inverse() * (now.T_organ_proxy * contact.point);
    velocity += (contact.point - before) / kVelocitySec;
  }
  return velocity;
}

TissuePush tissue_push(const ProxyScene& scene, const std::vector<ProxyOrgan>& before,
                       const ProxyAnswer& answer, bool has_levers) {
  TissuePush push;
  double sum = 0.0;
  const auto add = [&](std::size_t organ, const FaceContact& at, const Vector3d& load) {
    if (load.isZero(0.0)) return;
    const Vector3d along = load.normalized();
    const double lever = has_levers && at.link == kShaft ? std::max(at.shaft, kLeastLever) : 1.0;
    const Vector3d weighted = load / lever;
    push.way += along.dot(way_of(before, scene.organs[organ], at.face, at.barycentric)) * weighted;
    push.velocity += along.dot(tissue_velocity(scene, organ, at)) * weighted;
    sum += load.norm();
  };
  for (const ProxyFace& at : answer.contacts) {
    add(at.organ, at.contact, at.load * at.contact.normal);
  }
  for (const ProxyCrossing& at : answer.crossings) {
    FaceContact place;
    place.face = at.face;
    place.barycentric = at.barycentric;
    place.shaft = at.shaft;
    place.point = at.point;
    add(at.organ, place, at.load);
  }
  if (sum > 0.0) push = {push.way / sum, push.velocity / sum};
  return push;
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
  const FrameLimit limit = frame_limit(limits);
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
    if (is_old(T_organ_proxy.found->stamp, limit, now)) {
      throw stale_frame(
          {oldest_between(transforms, organ.frame(), frame), T_organ_proxy.found->stamp}, limit,
          now);
    }
    scene.stamps.push_back(T_organ_proxy.found->stamp);
    scene.organs.push_back(
        {name, shape_of(organ), organ.latest().topology(), T_organ_proxy.found->value});
    scene.sources.push_back(&organ);
    TissueMotion& motion = scene.motions.emplace_back(motion_of(organ, now));
    const ros::Time stamp = T_organ_proxy.found->stamp;
    if (stamp.toSec() > kVelocitySec && transforms.goes_on(organ.frame(), {frame}, stamp, now)) {
      const ros::Time before = stamp - ros::Duration(kVelocitySec);
      const auto T_before = look_up(transforms, organ.frame(), frame, before);
      if (T_before.found) motion.T_before = T_before.found->value;
    }
  }
  return scene;
}

void check_age(const TransformBuffer& transforms, const std::string& frame,
               const TransformBuffer::Frames& tool_frames, ros::Time stamp, const AgeLimits& limits,
               ros::Time now) {
  const FrameLimit limit = frame_limit(limits);
  // No transform behind the pose is older than the pose, so all are recent if the pose is.
  if (!is_old(stamp, limit, now)) return;
  const auto oldest = transforms.oldest_transform(frame, tool_frames);
  if (oldest && is_old(oldest->stamp, limit, now)) throw stale_frame(*oldest, limit, now);
}

}  // namespace organ_collision
