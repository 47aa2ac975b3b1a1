#include "proxy_forces.hpp"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// [m] A shaft shorter than this is no lever.
constexpr double kShortestLever = 1e-9;

/// A loaded place of an organ.
struct Place {
  std::size_t organ;
  Triangle corners;  ///< [m] of the face, in the proxy's frame
  FaceForce at;      ///< in the proxy's frame; `force` [m]: on the proxy, divided by the stiffness
};

std::vector<Place> places_of(const ProxyAnswer& answer, const std::vector<ProxyOrgan>& organs) {
  std::vector<Place> places;
  const auto add = [&](std::size_t organ, std::uint32_t face, std::int32_t link,
                       const Vector3d& barycentric, const Vector3d& force) {
    if (force.isZero(0.0)) return;
    const TriangleMesh& shape = *organs[organ].shape;
    const Eigen::Isometry3d T_proxy_organ = organs[organ].T_organ_proxy.inverse();
    Triangle corners = shape.triangle(face);
    for (Vector3d& corner : corners) corner = T_proxy_organ * corner;
    const FaceIndices vertices = shape.faces()[face];
    places.push_back({organ,
                      corners,
                      {face, link, vertices, barycentric, point_at(corners, barycentric), force}});
  };
  for (const ProxyFace& near : answer.contacts) {
    const FaceContact& contact = near.contact;
    add(near.organ, contact.face, contact.link, contact.barycentric, -near.load * contact.normal);
  }
  for (const ProxyCrossing& crossing : answer.crossings) {
    add(crossing.organ, crossing.face, kShaft, crossing.barycentric, -crossing.load);
  }
  return places;
}

/// The force at the tip of a shaft that comes from a force at a point of the tool. The tool is a
/// lever about its trocar. Along the axis, the force acts in full.
Vector3d at_tip(const FaceForce& at, const ShaftAxis& axis) {
  const Vector3d along = axis.along();
  if (along.norm() < kShortestLever) return at.force;
  return at.force + (at.place - axis.tip).cross(at.force).cross(along) / along.squaredNorm();
}

/// The torque of forces about the hand's centre is that about the proxy's centre plus pull x sum of
/// the forces. The latter vanishes where the proxy has come to rest, because the sum then has the
/// direction of the pull. Adds the smallest forces at the corners of the loaded faces that make it
/// vanish everywhere, each weighted by the load of its face. For a ball, they are no larger than
/// the loads. Where they would be larger, they are made smaller.
void add_balance(const ProxyAnswer& answer, std::vector<Place>& places) {
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  Vector3d torque = Vector3d::Zero();
  double loads = 0.0;
  for (const Place& place : places) {
    const double load = place.at.force.norm();
    loads += load;
    torque -= answer.pull.cross(place.at.force);
    for (const Vector3d& corner : place.corners) {
      const Vector3d arm = corner - answer.center;
      inertia += load * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
    }
  }
  Vector3d turn = inertia.completeOrthogonalDecomposition().solve(torque);
  const double squares = torque.dot(turn);  // of the forces, each divided by its weight
  constexpr double kMost = 2.0;             // twice, so that rounding errors change no ball's
  if (squares > kMost * loads) turn *= std::sqrt(kMost * loads / squares);
  const std::size_t count = places.size();
  for (std::size_t i = 0; i < count; ++i) {
    for (int k = 0; k < 3; ++k) {
      Place corner = places[i];
      corner.at.barycentric = Vector3d::Unit(k);
      corner.at.place = corner.corners[static_cast<std::size_t>(k)];
      corner.at.force =
          places[i].at.force.norm() * turn.cross(Vector3d(corner.at.place - answer.center));
      places.push_back(corner);
    }
  }
}

}  // namespace

double share_within_limit(const Vector3d& load, double most) {
  const double magnitude = load.stableNorm();
  return magnitude <= most ? 1.0 : most / magnitude;
}

Vector3d force_of(const std::vector<OrganForce>& forces) {
  Vector3d sum = Vector3d::Zero();
  for (const OrganForce& of_organ : forces) sum += of_organ.force;
  return sum;
}

Vector3d torque_of(const std::vector<OrganForce>& forces) {
  Vector3d sum = Vector3d::Zero();
  for (const OrganForce& of_organ : forces) sum += of_organ.torque;
  return sum;
}

void OrganForce::scale(double factor) {
  force *= factor;
  torque *= factor;
  for (FaceForce& at : on_faces) at.force *= factor;
}

std::vector<OrganForce> proxy_forces(const ProxyAnswer& answer,
                                     const std::vector<ProxyOrgan>& organs, ProxyFreedom freedom,
                                     double stiffness, const Vector3d& damping) {
  std::vector<OrganForce> forces(organs.size());
  for (std::size_t i = 0; i < organs.size(); ++i) {
    forces[i].organ = organs[i].name;
    forces[i].topology = organs[i].shape->topology();
  }
  const bool is_free = freedom == ProxyFreedom::kFree;
  std::vector<Place> places = places_of(answer, organs);
  if (is_free) add_balance(answer, places);
  for (Place& place : places) {
    OrganForce& of_organ = forces[place.organ];
    FaceForce& at = place.at;
    of_organ.force += is_free ? at.force : at_tip(at, answer.proxy.axis);
    if (is_free) of_organ.torque += (at.place - answer.center).cross(at.force);
    const Eigen::Isometry3d& T_organ_proxy = organs[place.organ].T_organ_proxy;
    at.place = T_organ_proxy * at.place;
    at.force = T_organ_proxy.linear() * at.force;
    of_organ.on_faces.push_back(at);
  }
  double factor = stiffness;
  const Vector3d whole = force_of(forces);
  if (!whole.isZero(0.0)) {
    factor += std::clamp(damping.dot(whole) / whole.squaredNorm(), -stiffness, stiffness);
  }
  for (OrganForce& of_organ : forces) of_organ.scale(factor);
  return forces;
}

}  // namespace organ_collision
