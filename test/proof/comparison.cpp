#include "comparison.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>

#include "exact_distance.hpp"
#include "exact_volume.hpp"
#include "first_touch_oracle.hpp"
#include "geometry/distance/first_touch.hpp"

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;

TriangleMesh mesh_of(const Triangle& face) {
  std::vector<float> vertices;
  for (const Vector3d& corner : face) {
    for (int k = 0; k < 3; ++k) vertices.push_back(static_cast<float>(corner[k]));
  }
  return {vertices, {0, 1, 2}};
}

/// The largest coordinate of the face relative to `origin` [m].
double extent(const Triangle& face, const Vector3d& origin) {
  double largest = 0.0;
  for (const Vector3d& corner : face)
    largest = std::max(largest, (corner - origin).cwiseAbs().maxCoeff());
  return largest;
}

bool picks(Picker& picker, const ViewingVolume& volume, const TriangleMesh& mesh) {
  std::vector<Candidate> candidates;
  picker.pick(volume, mesh, candidates);
  picker.release();
  return !candidates.empty();
}

void report(const char* what, const Trial& trial) {
  std::cout << what << ": " << to_line(trial) << std::endl;
}

}  // namespace

Comparison::Comparison() {
  for (const PickerKind kind : {PickerKind::kFeedback, PickerKind::kSelect, PickerKind::kCpu}) {
    pickers_.push_back(make_picker(kind));
  }
}

Tally Comparison::at_rest(const Trial& trial) {
  return capsule({trial.motion.end, trial.motion.end}, trial);
}

Tally Comparison::swept(const Trial& trial) { return capsule(trial.motion, trial); }

Tally Comparison::capsule(const ShaftMotion& motion, const Trial& trial) {
  const bool touching = within(core(motion), trial.face, trial.radius);
  const bool found = first_touch(motion, {trial.face, trial.face}, trial.radius).has_value();
  Tally tally;
  tally.pairs = 1;
  tally.touching = touching;
  if (touching != found) {
    tally.farthest = std::abs(distance(core(motion), trial.face) - trial.radius);
    const bool outside = tally.farthest > kBand;
    ++(outside ? tally.outside_band : tally.inside_band);
    if (outside) report("differs from exact distance", trial);
  }
  if (!touching && !found) return tally;
  const double largest = extent(trial.face, motion.start.trocar);
  const ViewingVolume volume = conservative_volume(motion, trial.radius, {0.0, largest});
  const TriangleMesh mesh = mesh_of(trial.face);
  for (const std::unique_ptr<Picker>& picker : pickers_) {
    if (picks(*picker, volume, mesh)) continue;
    ++tally.missed;
    report("missed by a picker", trial);
  }
  return tally;
}

Tally Comparison::volume(const ViewingVolume& volume, const Trial& trial) {
  const double largest = extent(trial.face, volume.origin());
  const auto inside = [&](double share) {
    return meets(trial.face, volume.origin(), half_spaces(volume, largest, share));
  };
  const bool exact = inside(0.0), surely = inside(-1.0), maybe = inside(1.0);
  const TriangleMesh mesh = mesh_of(trial.face);
  Tally tally;
  tally.pairs = 1;
  tally.touching = exact;
  for (const std::unique_ptr<Picker>& picker : pickers_) {
    const bool picked = picks(*picker, volume, mesh);
    if (picked == exact) continue;
    const bool outside = picked ? !maybe : surely;
    ++(outside ? tally.outside_band : tally.inside_band);
    if (outside) report("differs from exact half-spaces", trial);
  }
  return tally;
}

Tally Comparison::moving(const Trial& trial, Random& random) {
  constexpr double kSlack = 1e-6;  // [m]
  ShaftMotion motion = trial.motion;
  motion.start.trocar += random.scale(1e-4, 0.05) * random.direction();
  FaceMotion face{trial.face, trial.face};
  for (Vector3d& corner : face.start) corner += random.scale(1e-4, 0.05) * random.direction();
  face.start = rounded(face.start);

  const TriangleMesh organ = mesh_of(face.end), before = mesh_of(face.start);
  CollisionRequest request;
  request.organ = &organ;
  request.organ_before = &before;
  request.path = {{0.0, motion.start}, {1.0, motion.end}};
  request.radius = trial.radius;
  request.mode = QueryMode::kSwept;
  CollisionResult result;
  query_.evaluate(request, result);

  const FirstTime first = first_time_within(motion, face, trial.radius, kSlack);
  const bool found = !result.contacts.empty();
  Tally tally;
  tally.pairs = 1;
  tally.touching = first.certainly.has_value();
  tally.missed = !found && first.certainly;
  bool wrong = tally.missed || (found && !first.possibly);
  if (found && first.possibly) {
    const double time = result.contacts[0].fraction;
    wrong = time < *first.possibly - kBand || time > first.certainly.value_or(1.0) + kBand;
  }
  tally.outside_band = wrong;
  if (wrong) report("differs from search", trial);
  return tally;
}

}  // namespace organ_collision::oracle
