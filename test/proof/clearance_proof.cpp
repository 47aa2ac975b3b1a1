#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <vector>

#include "exactness_proof.hpp"
#include "link_trials.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "step_oracle.hpp"

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;

constexpr double kAtRest = 1e-9;    // [m] the largest error of a distance at rest
constexpr double kInMotion = 1e-6;  // [m] the largest error of the least distance of a step

CollisionRequest request_for(const ClearanceTrial& trial) {
  const ToolStep& step = trial.step;
  CollisionRequest request;
  request.organ = &step.now;
  request.organ_before = &step.before;
  request.path = step.path;
  request.radius = step.radius;
  if (!step.links.empty()) request.links = &step.links;
  request.mode = step.at_rest() ? QueryMode::kStatic : QueryMode::kSwept;
  request.margin = trial.margin;
  request.clearance = trial.margin == 0.0;
  return request;
}

/// The error that the doubles of the trial's coordinates explain [m].
double rounding(const ToolStep& step) { return 1e-15 * largest_coordinate(step.now); }

/// Whether the nearest points belong together, to the face and to the core. If core and face meet,
/// the normal is that of the face, and the point of the core is off by their distance.
bool pair_is_consistent(const ToolStep& step, const ToolClearance& found) {
  const double band = kAtRest + rounding(step);
  const Triangle face = face_at(step, found.face, 1.0);
  Vector3d point = Vector3d::Zero();
  for (int i = 0; i < 3; ++i) point += found.barycentric[i] * face[i];
  const double from_core = found.distance + surface_radius(step);
  const Vector3d on_core = found.on_organ - from_core * found.normal;
  const bool defined = from_core > tolerance::kPierced;
  return found.vertices == step.now.faces()[found.face] && found.barycentric.minCoeff() >= 0.0 &&
         std::abs(found.barycentric.sum() - 1.0) <= 1e-12 &&
         (point - found.on_organ).norm() <= band && std::abs(found.normal.norm() - 1.0) <= 1e-12 &&
         found.normal_defined == defined &&
         (found.on_organ - found.on_tool - found.distance * found.normal).norm() <= band &&
         is_near_core(step, on_core, defined ? band : band + 2.0 * from_core);
}

/// Whether the distance at the end is that of the nearest face, to within the tolerance.
bool end_is_right(const ToolStep& step, const ToolClearance& found) {
  const double band = kAtRest + rounding(step);
  return !is_within(step, 1.0, found.distance - band) &&
         is_within(step, found.face, 1.0, found.distance + band);
}

bool margin_is_right(const ClearanceTrial& trial, const ToolClearance& found) {
  const double margin = trial.margin > 0.0 ? trial.margin : INFINITY;
  const double band = kAtRest + rounding(trial.step);
  if (found.state == ClearanceState::kKnown) return found.distance <= margin + band;
  return found.state == ClearanceState::kBeyondMargin && margin < INFINITY &&
         !is_within(trial.step, 1.0, margin - band);
}

/// `closest`: the smallest distance that the search saw [m].
bool least_is_right(const ToolStep& step, const CollisionResult& result, double& closest) {
  const ToolClearance& found = result.clearance;
  const double band = kAtRest + rounding(step);
  closest = found.least;
  if (step.at_rest()) return found.least == found.distance;
  if (!result.contacts.empty()) {
    const double touch = tolerance::kConvexMargin + band;
    double first = 1.0;
    for (const FaceContact& contact : result.contacts) first = std::min(first, contact.fraction);
    return found.least == 0.0 && found.least_fraction == first && is_within(step, first, touch);
  }
  return is_within(step, found.least_fraction, found.least + band) &&
         stays_above(step, found.least - kInMotion, closest);
}

/// Whether the contacts are those of the oracle: each face is touched at the contact's time and, at
/// some times before it, not yet; a face without a contact is touched at none of these times; and
/// `touching` tells of the end.
bool contacts_are_right(const ToolStep& step, const CollisionResult& result) {
  const double band = kAtRest + rounding(step), touch = tolerance::kConvexMargin + band;
  const double late = step.at_rest() ? band : kInMotion;
  std::vector<double> first(step.now.face_count(), 1.0 + 1e-9);  // when a face is touched
  for (const FaceContact& contact : result.contacts) {
    first[contact.face] = std::min(first[contact.face], contact.fraction);
    if (!is_within(step, contact.face, contact.fraction, step.at_rest() ? touch : kInMotion)) {
      return false;
    }
    const bool is_near_at_end =
        is_within(step, contact.face, 1.0, contact.touching ? touch : -band);
    if (is_near_at_end != contact.touching) return false;
  }
  for (std::size_t face = 0; face < first.size(); ++face) {
    constexpr int kTimes = 8;
    for (int i = 0; i <= kTimes; ++i) {
      const double time = i / static_cast<double>(kTimes);
      if (time < first[face] - 1e-6 && is_within(step, face, time, -late)) return false;
    }
  }
  return true;
}

}  // namespace

Tally compare_clearance(const ClearanceTrial& trial, CollisionQuery& query) {
  const ToolStep& step = trial.step;
  CollisionResult result;
  query.evaluate(request_for(trial), result);
  const ToolClearance& found = result.clearance;
  const bool is_known = found.state == ClearanceState::kKnown;
  bool right =
      found.is_resolved && margin_is_right(trial, found) && contacts_are_right(step, result);
  double closest = found.least;
  if (is_known) {
    right = right && end_is_right(step, found) && pair_is_consistent(step, found) &&
            least_is_right(step, result, closest);
  }
  Tally tally;
  tally.count("pairs", 1);
  tally.count("known", is_known);
  tally.count("touched", !result.contacts.empty());
  tally.count("wrong", !right);
  tally.keep_most("distance off by at most [m]",
                  is_known ? std::abs(found.distance - rounded_distance(step, 1.0)) : 0.0);
  tally.keep_most("least above the closest seen by at most [m]", found.least - closest);
  if (!right) {
    std::cout << "clearance differs: state " << static_cast<int>(found.state) << " distance "
              << std::setprecision(17) << found.distance << " least " << found.least << " at "
              << found.least_fraction << " margin " << trial.margin << ", "
              << result.contacts.size() << " contacts\n"
              << step << std::endl;
  }
  return tally;
}

bool prove_clearance(const ProofSize& size, Progress& progress) {
  CollisionQuery query(size.pickers.front());
  bool all_right = true;
  const auto prove = [&](const std::string& what, const std::vector<std::string>& kinds, long pairs,
                         const auto& make_trial_of) {
    const long each = pairs / static_cast<long>(kinds.size()) + 1;
    std::vector<Tally> tallies(kinds.size());
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
      Random random(1000 * size.seed + kind);
      for (long i = 0; i < each; ++i) {
        progress.show(what + ", " + kinds[kind], i, each);
        tallies[kind].add(compare_clearance(make_trial_of(kind, random), query));
      }
    }
    print_table(what, kinds, tallies);
    all_right = sum_of(tallies).get("wrong") == 0.0 && all_right;
  };
  const std::vector<std::string>& parts = link_part_kinds();
  const long moving = size.pairs / 10, of_part = moving / static_cast<long>(parts.size());
  prove("shaft at rest", trial_kinds(), size.pairs, make_resting_shaft);
  prove("moving shaft", trial_kinds(), moving / 2, make_moving_shaft);
  for (std::size_t part = 0; part < parts.size(); ++part) {
    prove(parts[part] + " at rest", link_trial_kinds(), of_part,
          [&](std::size_t kind, Random& random) { return make_resting_link(kind, part, random); });
    prove("moving " + parts[part], link_trial_kinds(), of_part / 2,
          [&](std::size_t kind, Random& random) { return make_moving_link(kind, part, random); });
  }
  return all_right;
}

}  // namespace organ_collision::oracle
