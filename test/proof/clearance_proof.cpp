#include "clearance_proof.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
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
    return found.least == 0.0 && is_within(step, found.least_fraction, touch);
  }
  return is_within(step, found.least_fraction, found.least + band) &&
         stays_above(step, found.least - kInMotion, closest);
}

}  // namespace

void ClearanceTally::add(const ClearanceTally& other) {
  pairs += other.pairs;
  known += other.known;
  touched += other.touched;
  wrong += other.wrong;
  distance = std::max(distance, other.distance);
  least = std::max(least, other.least);
}

void print_clearance_head(const std::string& what) {
  std::cout << "\n| " << std::left << std::setw(18) << what
            << " |     pairs |     known |   touched |     wrong | distance off by at most [m] | "
               "least above the closest seen by at most [m] |\n"
            << "|---|---|---|---|---|---|---|\n";
}

void print(const std::string& name, const ClearanceTally& tally) {
  std::cout << "| " << std::left << std::setw(18) << name << std::right;
  for (const long count : {tally.pairs, tally.known, tally.touched, tally.wrong}) {
    std::cout << " | " << std::setw(9) << count;
  }
  for (const double error : {tally.distance, tally.least}) {
    std::cout << " | " << std::setw(9) << std::setprecision(2) << error;
  }
  std::cout << " |" << std::endl;
}

ClearanceTally ClearanceComparison::compare(const ClearanceTrial& trial) {
  const ToolStep& step = trial.step;
  query_.evaluate(request_for(trial), result_);
  const ToolClearance& found = result_.clearance;
  ClearanceTally tally;
  tally.pairs = 1;
  tally.touched = !result_.contacts.empty();
  bool right = found.is_resolved && margin_is_right(trial, found);
  if (right && found.state == ClearanceState::kKnown) {
    tally.known = 1;
    tally.distance = std::abs(found.distance - rounded_distance(step, 1.0));
    double closest = found.least;
    right = end_is_right(step, found) && pair_is_consistent(step, found) &&
            least_is_right(step, result_, closest);
    tally.least = std::max(0.0, found.least - closest);
  }
  if (!right) {
    tally.wrong = 1;
    std::cout << "clearance differs: state " << static_cast<int>(found.state) << " distance "
              << std::setprecision(17) << found.distance << " least " << found.least << " at "
              << found.least_fraction << " margin " << trial.margin << '\n'
              << step << std::endl;
  }
  return tally;
}

namespace {

using MakeTrial = std::function<ClearanceTrial(std::size_t kind, Random& random)>;

/// Prints a table with a line for each kind. Returns whether all answers were right.
bool prove_kinds(const std::string& what, const std::vector<std::string>& kinds, long pairs,
                 std::uint64_t seed, const MakeTrial& make, Progress& progress) {
  const long each = pairs / static_cast<long>(kinds.size()) + 1;
  ClearanceComparison comparison;
  ClearanceTally all;
  print_clearance_head(what);
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    Random random(1000 * seed + kind);
    ClearanceTally tally;
    for (long i = 0; i < each; ++i) {
      progress.show(what + ", " + kinds[kind], i, each);
      tally.add(comparison.compare(make(kind, random)));
    }
    print(kinds[kind], tally);
    all.add(tally);
  }
  print("all", all);
  return all.wrong == 0;
}

}  // namespace

bool prove_clearance(long pairs, unsigned long seed, Progress& progress) {
  const std::vector<std::string>& parts = link_part_kinds();
  const long moving = pairs / 10;
  const long each_part = static_cast<long>(parts.size());
  bool right =
      prove_kinds("shaft at rest", trial_kinds(), pairs, seed, make_resting_shaft, progress);
  right =
      prove_kinds("moving shaft", trial_kinds(), moving / 2, seed, make_moving_shaft, progress) &&
      right;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    const auto resting = [part](std::size_t kind, Random& random) {
      return make_resting_link(kind, part, random);
    };
    const auto in_motion = [part](std::size_t kind, Random& random) {
      return make_moving_link(kind, part, random);
    };
    right = prove_kinds(parts[part] + " at rest", link_trial_kinds(), moving / each_part, seed,
                        resting, progress) &&
            right;
    right = prove_kinds("moving " + parts[part], link_trial_kinds(), moving / 2 / each_part, seed,
                        in_motion, progress) &&
            right;
  }
  return right;
}

}  // namespace organ_collision::oracle
