#include "force_law.hpp"

#include <optional>

#include "penalty_forces.hpp"
#include "ros/interface/conversions.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// [1] The allowed change of force, as a multiple of stiffness * motion. A flat surface needs 1, a
/// crease 2, a narrow crease more.
constexpr double kSteepness = 4.0;
/// [m/s] The allowed change of force while the tool rests, divided by stiffness and time.
constexpr double kSettling = 0.05;

/// The contacts' faces, and then the clearance's face if there is a push for it. Without forces.
std::vector<FaceForce> faces_of(const ContactArray& answer, const std::vector<Push>& pushes) {
  std::vector<FaceForce> faces;
  faces.reserve(pushes.size());
  for (const Contact& contact : answer.contacts) {
    faces.push_back({contact.face, contact.link, contact.vertices, contact.barycentric,
                     to_eigen(contact.end_point)});
  }
  if (pushes.size() > faces.size()) {
    const Clearance& clearance = answer.clearance;
    faces.push_back({clearance.face, clearance.link, clearance.vertices, clearance.barycentric,
                     to_eigen(clearance.on_organ)});
  }
  return faces;
}

Vector3d sum_of(const std::vector<FaceForce>& forces) {
  Vector3d sum = Vector3d::Zero();
  for (const FaceForce& at : forces) sum += at.force;
  return sum;
}

/// Adds `force` to `forces`, in proportion to `weights`. To all alike if the weights are zero.
void spread(const Vector3d& force, const std::vector<double>& weights,
            std::vector<FaceForce>& forces) {
  double sum = 0.0;
  for (const double weight : weights) sum += weight;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    forces[i].force += (sum > 0.0 ? weights[i] / sum : 1.0 / forces.size()) * force;
  }
}

}  // namespace

/// Interpolates from the last forces to `forces`. `share`: 0 gives the last ones, 1 gives `forces`.
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
  spread(lost, weights, forces);
}

std::vector<FaceForce> ForceLaw::follow(const ContactArray& answer, double seconds,
                                        double stiffness, const KeptSides::Radius& shaft_radius) {
  const std::vector<Push> pushes = way_out_.follow(answer, shaft_radius);
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
