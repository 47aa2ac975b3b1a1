#include "force_law.hpp"

#include <cmath>
#include <numeric>

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// [1] Cosine of the largest angle by which the normal of a pierced face turns in a step. If the
/// normal turned more, one of the two contacts is from before the face was pierced, and their
/// depths cannot be compared.
constexpr double kSame = 0.999;
/// [1] The cosine of this angle for a link, in the step after first touch. The face then pierces
/// the link, and the normal becomes that of the face. Depths can be compared only if this changes
/// nothing.
constexpr double kExactlySame = 1.0 - 1e-9;

/// [1] The allowed change of force, as a multiple of stiffness * motion. A flat surface needs 1, a
/// crease 2, a narrow crease more.
constexpr double kSteepness = 4.0;
/// [m/s] The allowed change of force while the tool rests, divided by stiffness and time.
constexpr double kSettling = 0.05;

std::optional<double> known_distance(const Clearance& clearance) {
  if (clearance.state != Clearance::KNOWN || clearance.unresolved) return std::nullopt;
  return clearance.distance;
}

/// The contacts' faces, and the clearance's face if there is a push for it. All forces are zero.
std::vector<FaceForce> faces_of(const ContactArray& answer, const std::vector<Push>& pushes) {
  std::vector<FaceForce> faces;
  faces.reserve(pushes.size());
  const auto add = [&faces](const auto& at, const geometry_msgs::Point& place) {
    const auto& v = at.vertices;
    const auto& b = at.barycentric;
    faces.push_back({at.face, at.link, {v[0], v[1], v[2]}, {b[0], b[1], b[2]}, to_eigen(place)});
  };
  for (const Contact& contact : answer.contacts) add(contact, contact.on_organ);
  if (pushes.size() > faces.size()) add(answer.clearance, answer.clearance.on_organ);
  return faces;
}

}  // namespace

double ContactMotion::path_length_between(const Place& before, const Place& now) {
  const double agreement = before.normal().dot(now.normal());
  const double nearer = now.depth() - before.depth();
  if (!before.radius || !now.radius) {
    const bool was_new = before.contact.fraction > 0.0;
    return agreement > (was_new ? kExactlySame : kSame) ? std::abs(nearer) : 0.0;
  }
  if (before.is_pierced() && now.is_pierced() && agreement > kSame) {
    return std::min(std::abs(now.contact.depth - before.contact.depth),
                    std::abs(now.push.depth - before.push.depth));
  }
  const Vector3d change = now.offset() - before.offset();
  const double farther = change.dot(before.offset().normalized());
  return std::max({0.5 * change.norm(), nearer, farther});
}

/// [m] A lower bound of the motion if the face was not touched in the last answer.
double ContactMotion::path_length_to(const Place& now) {
  // If the face was not touched when the step began, its whole depth arose in this step.
  if (now.contact.fraction > 0.0) return now.contact.depth;
  // A face that pierces a link at once may have the link's whole thickness as its depth.
  return now.radius ? now.depth() : 0.0;
}

std::optional<double> ContactMotion::follow(const ContactArray& answer,
                                            const std::vector<Push>& pushes,
                                            const ShaftRadius& shaft_radius) {
  double way = 0.0;
  Places places;
  for (std::size_t i = 0; i < answer.contacts.size(); ++i) {
    const Contact& contact = answer.contacts[i];
    const Place now{contact, pushes[i], radius_at(contact, shaft_radius)};
    places.insert({{contact.face, contact.link}, now});
    if (!last_) continue;
    const auto before = last_->find({contact.face, contact.link});
    if (before == last_->end()) {
      way = std::max(way, path_length_to(now));
    } else {
      way = std::max(way, path_length_between(before->second, now));
      last_->erase(before);
    }
  }
  const bool follows = last_.has_value();
  if (follows) {
    for (const auto& [face, left] : *last_) {
      // If the tool passed through the face, its distance from the face is not known.
      if (left.radius && !left.offset().isZero(0.0)) way = std::max(way, left.depth());
    }
  }
  const std::optional<double> distance = known_distance(answer.clearance);
  if (follows && distance && last_distance_) {
    way = std::max(way, std::abs(*distance - *last_distance_));
  }
  last_ = std::move(places);
  last_distance_ = distance;
  return follows ? std::optional<double>(way) : std::nullopt;
}

/// Interpolates from the last forces to `forces`. `share`: 0 gives the last forces, 1 gives
/// `forces`. The last forces of faces that are gone are shared in proportion to `forces`, or
/// equally if these are zero.
void ForceLaw::blend_with_last(std::vector<FaceForce>& forces, double share) {
  std::vector<double> weights;
  for (FaceForce& at : forces) {
    weights.push_back(at.force.stableNorm());
    at.force *= share;
    const auto last = last_.find({at.face, at.link});
    if (last == last_.end()) continue;
    at.force += (1.0 - share) * last->second;
    last_.erase(last);
  }
  Vector3d lost = Vector3d::Zero();
  for (const auto& [face, force] : last_) lost += (1.0 - share) * force;
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (std::size_t i = 0; i < forces.size(); ++i) {
    forces[i].force += (sum > 0.0 ? weights[i] / sum : 1.0 / forces.size()) * lost;
  }
}

std::vector<FaceForce> ForceLaw::follow(const ContactArray& answer, double seconds,
                                        double stiffness, const ShaftRadius& shaft_radius) {
  if (answer.mode == ContactArray::STATIC || answer.topology != topology_) {
    *this = ForceLaw(way_out_);
    topology_ = answer.topology;
  }
  const std::vector<Push> pushes = pushes_.follow(answer, shaft_radius);
  const std::optional<double> way = motion_.follow(answer, pushes, shaft_radius);
  const std::vector<Vector3d> penalties = penalty_forces(pushes, stiffness);
  std::vector<FaceForce> forces = faces_of(answer, pushes);
  for (std::size_t i = 0; i < forces.size(); ++i) forces[i].force = penalties[i];
  if (way && !forces.empty()) {
    Vector3d last = Vector3d::Zero();
    for (const auto& [face, force] : last_) last += force;
    const double most = stiffness * (kSteepness * *way + kSettling * seconds);
    const double change = (sum_of(forces) - last).stableNorm();
    if (change > most) blend_with_last(forces, most / change);
  }
  last_.clear();
  for (const FaceForce& at : forces) {
    last_.insert({{at.face, at.link}, Vector3d::Zero()}).first->second += at.force;
  }
  return forces;
}

}  // namespace organ_collision
