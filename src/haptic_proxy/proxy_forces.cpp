#include "proxy_forces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// A contact or a crossing, with its force.
struct Place {
  std::size_t organ;
  FaceForce on_face;  ///< in the proxy's frame; `force`: stiffness times load, on the proxy
  Vector3d on_hand;   ///< [N] the part of this force that acts on the hand at answer.center
};

/// The force at the tip [N] that comes from a force at the place `shaft` on the axis. Across the
/// axis, the axis is a lever about the trocar. Along the axis, the force acts in full.
Vector3d at_tip(const Vector3d& force, double shaft, const ShaftAxis& axis) {
  const Vector3d direction = (axis.tip - axis.trocar).normalized();
  const Vector3d lengthwise = direction.dot(force) * direction;
  return lengthwise + shaft * (force - lengthwise);
}

std::vector<Place> places_of(const ProxyAnswer& answer, const std::vector<ProxyOrgan>& organs,
                             bool has_levers, double stiffness) {
  std::vector<Place> places;
  places.reserve(answer.contacts.size() + answer.crossings.size());
  for (const ProxyFace& at : answer.contacts) {
    const FaceContact& contact = at.contact;
    const Vector3d force = -stiffness * at.load * contact.normal;
    const double lever = has_levers && contact.link == kShaft ? contact.shaft : 1.0;
    places.push_back(
        {at.organ,
         {contact.face, contact.link, contact.vertices, contact.barycentric, contact.point, force},
         lever * force});
  }
  for (const ProxyCrossing& at : answer.crossings) {
    const Vector3d force = -stiffness * at.load;
    places.push_back({at.organ,
                      {at.face, kShaft, organs[at.organ].shape->faces()[at.face], at.barycentric,
                       at.point, force},
                      at_tip(force, at.shaft, answer.proxy.axis)});
  }
  return places;
}

/// The share of each place in the force that the loads do not explain. The sum of the shares is 1.
std::vector<double> shares_of(const std::vector<Place>& places) {
  std::vector<double> shares;
  double sum = 0.0;
  for (const Place& place : places) sum += shares.emplace_back(place.on_face.force.norm());
  for (double& share : shares) {
    share = sum > 0.0 ? share / sum : 1.0 / static_cast<double>(places.size());
  }
  return shares;
}

Vector3d torque_of(const std::vector<OrganForce>& forces) {
  Vector3d sum = Vector3d::Zero();
  for (const OrganForce& of_organ : forces) sum += of_organ.torque;
  return sum;
}

/// Adds the forces on faces to those of the same faces and links, each once, so that their number
/// does not grow while forces are on their way. Those that are next to nothing are left out.
void add_forces(const std::vector<FaceForce>& more, std::vector<FaceForce>& faces) {
  constexpr double kNothing = 1e-12;  // [N]
  for (const FaceForce& at : more) {
    if (at.force.norm() <= kNothing) continue;
    const auto known = std::find_if(faces.begin(), faces.end(), [&](const FaceForce& face) {
      return face.face == at.face && face.link == at.link;
    });
    if (known == faces.end()) {
      faces.push_back(at);
    } else {
      known->force += at.force;
    }
  }
}

/// The forces at a share of the way from `from` to `to`. Each has the faces of both, except for
/// those of triangles that are gone.
std::vector<OrganForce> between(const std::vector<OrganForce>& from,
                                const std::vector<OrganForce>& to, double share) {
  std::vector<OrganForce> forces = to;
  for (OrganForce& of_organ : forces) of_organ.scale(share);
  for (OrganForce before : from) {
    before.scale(1.0 - share);
    const auto now = std::find_if(forces.begin(), forces.end(), [&](const OrganForce& of_organ) {
      return of_organ.organ == before.organ;
    });
    if (now == forces.end()) {
      forces.push_back(std::move(before));
      continue;
    }
    now->force += before.force;
    now->torque += before.torque;
    if (now->topology != before.topology || now->frame != before.frame) continue;
    add_forces(before.on_faces, now->on_faces);
  }
  return forces;
}

}  // namespace

Vector3d sum_of(const std::vector<OrganForce>& forces) {
  Vector3d sum = Vector3d::Zero();
  for (const OrganForce& of_organ : forces) sum += of_organ.force;
  return sum;
}

void OrganForce::scale(double factor) {
  force *= factor;
  torque *= factor;
  for (FaceForce& at : on_faces) at.force *= factor;
}

std::vector<OrganForce> proxy_forces(const ProxyAnswer& answer,
                                     const std::vector<ProxyOrgan>& organs, ProxyFreedom freedom,
                                     bool has_shaft, double stiffness, const Vector3d& damping) {
  std::vector<OrganForce> forces(organs.size());
  for (std::size_t i = 0; i < organs.size(); ++i) {
    forces[i].organ = organs[i].name;
    forces[i].topology = organs[i].shape->topology();
  }
  const bool acts_at_tip = freedom == ProxyFreedom::kTrocar;
  std::vector<Place> places = places_of(answer, organs, acts_at_tip && has_shaft, stiffness);
  const Vector3d whole = stiffness * answer.pull + damping;
  if (places.empty()) {
    const double share = 1.0 / static_cast<double>(organs.size());
    for (OrganForce& of_organ : forces) {
      of_organ.force = share * whole;
      of_organ.torque = share * (answer.center.cross(whole) + stiffness * answer.twist);
    }
    return forces;
  }
  const std::vector<double> shares = shares_of(places);
  Vector3d unexplained = whole;
  for (const Place& place : places) unexplained -= place.on_hand;

  // Torques are summed about answer.center, where the spring pulls the hand. The last loop moves
  // them to the frame's origin.
  Vector3d unexplained_torque = stiffness * answer.twist;
  for (std::size_t i = 0; i < places.size(); ++i) {
    Place& place = places[i];
    OrganForce& of_organ = forces[place.organ];
    of_organ.force += place.on_hand + shares[i] * unexplained;
    place.on_face.force += shares[i] * unexplained;
    const Eigen::Isometry3d& T_organ_proxy = organs[place.organ].T_organ_proxy;
    FaceForce& on_face = of_organ.on_faces.emplace_back(place.on_face);
    on_face.place = T_organ_proxy * place.on_face.place;
    on_face.force = T_organ_proxy.linear() * place.on_face.force;
    if (acts_at_tip) continue;
    const Vector3d torque = (place.on_face.place - answer.center).cross(place.on_face.force);
    of_organ.torque += torque;
    unexplained_torque -= torque;
  }
  if (!acts_at_tip) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      forces[places[i].organ].torque += shares[i] * unexplained_torque;
    }
  }
  for (OrganForce& of_organ : forces) of_organ.torque += answer.center.cross(of_organ.force);
  return forces;
}

const std::vector<OrganForce>& ForceRateLimit::follow(const std::vector<OrganForce>& target,
                                                      double rate, const Vector3d& center,
                                                      double size, Time now) {
  const auto passed = last_ ? now - *last_ : Time::duration(0);
  const std::chrono::duration<double> counted = std::min<Time::duration>(passed, kLongestStep);
  last_ = now;
  const double most = rate * counted.count();
  const Vector3d force = sum_of(target) - sum_of(forces_);
  const Vector3d torque = torque_of(target) - torque_of(forces_) - center.cross(force);
  const double change = std::max(force.norm(), size > 0.0 ? torque.norm() / size : 0.0);
  is_on_its_way_ = change > most;
  forces_ = is_on_its_way_ ? between(forces_, target, most / change) : target;
  if (size == 0.0) {
    for (OrganForce& of_organ : forces_) of_organ.torque = center.cross(of_organ.force);
  }
  return forces_;
}

void ForceRateLimit::rotate(const Eigen::Matrix3d& R_new_old) {
  for (OrganForce& of_organ : forces_) {
    of_organ.force = R_new_old * of_organ.force;
    of_organ.torque = R_new_old * of_organ.torque;
  }
}

}  // namespace organ_collision
