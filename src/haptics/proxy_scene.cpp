#include "proxy_scene.hpp"

#include <organ_collision/ContactArray.h>

#include <algorithm>
#include <cmath>

#include "common/messages/text.hpp"
#include "geometry/concatenate.hpp"
#include "haptic_proxy_parameters.hpp"
#include "node/steps/contact_array.hpp"
#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// The organ's name for a proxy. With another history, the organ gets another name, and is
/// therefore another organ: it does not carry the proxy from the old shape to the new one.
std::string name_of_history(const DeformableOrgan& organ) {
  const auto& [number, why] = organ.history();
  return why.empty() ? organ.name() : concatenate(organ.name(), " ", number);
}

/// [1] The least lever of a place near the trocar.
constexpr double kLeastLever = 0.1;

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

/// [m/s] The part of tissue_velocity() that comes from the organ's shapes.
Vector3d shape_velocity(const ProxyScene& scene, std::size_t organ, const FaceContact& contact) {
  const TissueMotion& motion = scene.motions[organ];
  if (!motion.shape_before) return Vector3d::Zero();
  return scene.organs[organ].T_organ_proxy.linear().transpose() *
         velocity_between(*motion.shape_before, *motion.shape_after, motion.shape_sec, contact.face,
                          contact.barycentric);
}

/// [m/s] The part that comes from the organ's frame.
Vector3d frame_velocity(const ProxyScene& scene, std::size_t organ, const FaceContact& contact) {
  const TissueMotion& motion = scene.motions[organ];
  if (!motion.T_before) return Vector3d::Zero();
  const Eigen::Isometry3d& T_now = scene.organs[organ].T_organ_proxy;
  const Vector3d before = motion.T_before->inverse() * (T_now * contact.point);
  return (contact.point - before) / kVelocitySec;
}

/// [m/s] No tissue of an organ moves faster.
struct Speeds {
  double of_shape = 0.0, of_frame = 0.0;  ///< the two parts of tissue_velocity()
};

Speeds fastest(const ProxyScene& scene, std::size_t organ) {
  Speeds most;
  const TissueMotion& motion = scene.motions[organ];
  if (motion.shape_before) {
    const auto vertices = [](const TriangleMesh& mesh) {
      return Eigen::Map<const Eigen::ArrayXf>(mesh.vertices().data(),
                                              static_cast<Eigen::Index>(mesh.vertices().size()));
    };
    const double way = (vertices(*motion.shape_after) - vertices(*motion.shape_before))
                           .abs()
                           .maxCoeff();  // along each axis
    most.of_shape = std::sqrt(3.0) * way / motion.shape_sec;
  }
  // A frame moves a point by an affine function of its place: a corner moves the farthest.
  const Eigen::AlignedBox3d box = scene.organs[organ].shape->box().cast<double>();
  for (int corner = 0; corner < 8; ++corner) {
    FaceContact at;
    at.point = scene.organs[organ].T_organ_proxy.inverse() *
               box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
    most.of_frame = std::max(most.of_frame, frame_velocity(scene, organ, at).norm());
  }
  return most;
}

}  // namespace

Vector3d tissue_velocity(const ProxyScene& scene, std::size_t organ, const FaceContact& contact) {
  return shape_velocity(scene, organ, contact) + frame_velocity(scene, organ, contact);
}

void tell_motion(const ProxyScene& scene, std::size_t organ, bool guards_lag, bool tells_rows,
                 ProxyOrgan& told) {
  constexpr double kMostAdvance = 0.02;  // [m] The search goes so far beyond the clearance.
  const TissueMotion& motion = scene.motions[organ];
  if (!motion.shape_before && !motion.T_before) return;
  const double lag = motion.shape_before ? motion.lag_sec : 0.0;
  const bool is_late = guards_lag && (lag > 0.0 || motion.frame_lag_sec > 0.0);
  if (!is_late && !tells_rows) return;
  const Speeds most = fastest(scene, organ);
  if (is_late) {
    told.advance = [&scene, organ](const FaceContact& contact) {
      const TissueMotion& late = scene.motions[organ];
      return -contact.normal.dot(late.lag_sec * shape_velocity(scene, organ, contact) +
                                 late.frame_lag_sec * frame_velocity(scene, organ, contact));
    };
    told.most_advance =
        std::min(kMostAdvance, lag * most.of_shape + motion.frame_lag_sec * most.of_frame);
  }
  if (tells_rows) {
    told.approach = [&scene, organ](const FaceContact& contact) {
      return -contact.normal.dot(tissue_velocity(scene, organ, contact));
    };
    told.most_approach = most.of_shape + most.of_frame;
  }
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
                       const ShapeOf& shape_of, ros::Time at) {
  if (organs.organs().empty()) throw no_organ();
  ProxyScene scene{frame, {}, {}};
  for (const auto& [name, organ] : organs.organs()) {
    const OrganShape& latest = organ.latest();
    const std::string stale = stale_fault(name, latest, now, limits.mesh_sec);
    if (!stale.empty()) {
      throw Rejection(ContactArray::STALE_MESH, reason_of(ContactArray::STALE_MESH), stale);
    }
    auto T_organ_proxy = look_up(transforms, organ.frame(), frame, at);
    if (!T_organ_proxy.found) T_organ_proxy = look_up(transforms, organ.frame(), frame, {});
    if (!T_organ_proxy.found) {
      throw Rejection(ContactArray::NO_TRANSFORM, reason_of(ContactArray::NO_TRANSFORM),
                      "organ '" + name + "': " + T_organ_proxy.why_not);
    }
    check_age(transforms, organ.frame(), {frame}, limits, now);
    check_age(transforms, frame, {organ.frame()}, limits, now);
    const ros::Time stamp = T_organ_proxy.found->stamp;
    scene.stamps.push_back(stamp);
    auto shape = shape_of(organ);
    scene.organs.push_back({name_of_history(organ), std::move(shape.value), latest.topology(),
                            T_organ_proxy.found->value});
    scene.sources.push_back(&organ);
    TissueMotion& motion = scene.motions.emplace_back(
        TissueMotion{latest.moves_from(now), latest.mesh, latest.motion_sec, shape.stamp});
    if (stamp.toSec() > kVelocitySec && transforms.goes_on(organ.frame(), {frame}, stamp, now)) {
      const ros::Time before = stamp - ros::Duration(kVelocitySec);
      const auto T_before = look_up(transforms, organ.frame(), frame, before);
      if (T_before.found) motion.T_before = T_before.found->value;
    }
  }
  return scene;
}

void check_age(const TransformBuffer& transforms, const std::string& frame,
               const TransformBuffer::Frames& others, const AgeLimits& limits, ros::Time now) {
  const bool is_of_frames =
      limits.frame_sec > 0.0 && !(limits.mesh_sec > 0.0 && limits.mesh_sec < limits.frame_sec);
  const double most = is_of_frames ? limits.frame_sec : limits.mesh_sec;
  if (!(most > 0.0)) return;
  const auto last = transforms.oldest_transform(frame, others);
  if (!last) return;
  const double age = now.toSec() - last->received.toSec();
  if (!(age > most)) return;
  throw Rejection(
      ContactArray::STALE_MESH, "stale frame",
      concatenate("the last transform of frame '", last->frame, "' came ", duration_text(age),
                  " ago; at most ", most, " s are allowed (",
                  is_of_frames ? names::kFrameTimeoutSec : names::kMeshTimeoutSec, ")"));
}

}  // namespace organ_collision
