#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <string>
#include <vector>

#include "exact_sides.hpp"
#include "exactness_proof.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "placement_trials.hpp"

namespace organ_collision::oracle {

namespace {

using Eigen::Vector3d;

constexpr double kBand = 1e-9;  // [m] the largest error of a place

/// What exact arithmetic says.
struct ExactPlacement {
  Side tip, trocar;
  std::vector<ExactCrossing> crossings;
  double length_inside;  ///< [m]
};

Side side_of(const Vector3d& point, int winding, const PlacementTrial& trial) {
  const bool is_on = std::any_of(trial.faces.begin(), trial.faces.end(),
                                 [&](const Triangle& face) { return is_exactly_on(face, point); });
  if (is_on) return Side::kOnSurface;
  return winding != 0 ? Side::kInside : Side::kOutside;
}

ExactPlacement exact_placement(const PlacementTrial& trial) {
  const auto& [trocar, tip] = trial.axis;
  int enclosed = exact_winding(trial.faces, trocar);
  ExactPlacement exact{side_of(tip, exact_winding(trial.faces, tip), trial),
                       side_of(trocar, enclosed, trial), exact_crossings(trial.faces, trial.axis),
                       0.0};
  double place = 0.0, inside = 0.0;
  for (const ExactCrossing& crossing : exact.crossings) {
    if (enclosed != 0) inside += crossing.shaft - place;
    enclosed += crossing.direction;
    place = crossing.shaft;
  }
  if (enclosed != 0) inside += 1.0 - place;
  exact.length_inside = inside * (tip - trocar).norm();
  return exact;
}

CollisionRequest request_for(const PlacementTrial& trial) {
  CollisionRequest request;
  request.organ = &trial.organ;
  request.path = resting_path({trial.axis, {}});
  request.radius = 1e-4;
  request.placement = true;
  request.surface_topology = &trial.topology;
  return request;
}

/// Whether the point of a crossing is where its place and its barycentric coordinates say.
bool is_consistent(const AxisCrossing& found, const PlacementTrial& trial, double band) {
  Vector3d point = Vector3d::Zero();
  for (int i = 0; i < 3; ++i) point += found.barycentric[i] * trial.faces[found.face][i];
  return found.vertices == trial.organ.faces()[found.face] && found.barycentric.minCoeff() >= 0.0 &&
         std::abs(found.barycentric.sum() - 1.0) <= 1e-12 && (point - found.point).norm() <= band &&
         (trial.axis.at(found.shaft) - found.point).norm() <= band;
}

/// Counts crossings. A crossing that the oracle does not have, or that occurs twice, is
/// superfluous.
void compare_crossings(const PlacementTrial& trial, const std::vector<ExactCrossing>& exact,
                       const std::vector<AxisCrossing>& found, double band, Tally& tally) {
  const double length = (trial.axis.tip - trial.axis.trocar).norm();
  std::vector<bool> is_found(exact.size(), false);
  double last = 0.0;
  for (const AxisCrossing& crossing : found) {
    const auto same = std::find_if(exact.begin(), exact.end(), [&](const ExactCrossing& other) {
      return other.face == crossing.face && other.direction == crossing.direction;
    });
    const auto index = static_cast<std::size_t>(same - exact.begin());
    if (same == exact.end() || is_found[index]) {
      tally.count("superfluous", 1);
      continue;
    }
    is_found[index] = true;
    const double error = std::abs(crossing.shaft - same->shaft) * length;
    tally.keep_most("place off by [m]", error);
    const bool in_order = same->shaft * length >= last - band;
    last = std::max(last, same->shaft * length);
    if (error > band || !in_order || !is_consistent(crossing, trial, band)) {
      tally.count("otherwise wrong", 1);
    }
  }
  tally.count("missed", std::count(is_found.begin(), is_found.end(), false));
}

bool is_right(const Tally& tally) {
  return tally.get("wrong sides") == 0.0 && tally.get("missed") == 0.0 &&
         tally.get("superfluous") == 0.0 && tally.get("otherwise wrong") == 0.0;
}

/// Compares a placement with exact arithmetic. Prints the trial if they differ.
Tally compare(const PlacementTrial& trial, const AxisPlacement& found) {
  const ExactPlacement exact = exact_placement(trial);
  const double band = kBand + 1e-15 * largest_coordinate(trial.organ);
  const double length_off = std::abs(found.length_inside - exact.length_inside);
  Tally tally;
  tally.count("pairs", 1);
  tally.count("tips inside", exact.tip == Side::kInside);
  tally.count("on a face", exact.tip == Side::kOnSurface);
  tally.count("crossings", static_cast<long>(exact.crossings.size()));
  tally.count("wrong sides", (found.tip != exact.tip) + (found.trocar != exact.trocar));
  compare_crossings(trial, exact.crossings, found.crossings, band, tally);
  tally.count("otherwise wrong", !found.length_known || length_off > band);
  tally.keep_most("length off by [m]", length_off);
  if (!is_right(tally)) {
    std::cout << "placement differs: tip " << static_cast<int>(found.tip) << " instead of "
              << static_cast<int>(exact.tip) << ", trocar " << static_cast<int>(found.trocar)
              << " instead of " << static_cast<int>(exact.trocar) << ", " << found.crossings.size()
              << " crossings instead of " << exact.crossings.size() << '\n'
              << trial << std::endl;
  }
  return tally;
}

ClearanceTrial clearance_of(const PlacementTrial& trial, Random& random) {
  return {{trial.organ, trial.organ, resting_path({trial.axis, {}}), random.scale(1e-4, 1e-2), {}},
          0.0};
}

}  // namespace

bool prove_placement(const ProofSize& size, Progress& progress) {
  const std::vector<std::string>& kinds = placement_trial_kinds();
  const long each = size.pairs / static_cast<long>(kinds.size()) + 1;
  CollisionQuery query(size.pickers.front());
  CollisionResult result;
  std::vector<Tally> placements(kinds.size()), clearances(kinds.size());
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    Random random(1000 * size.seed + kind);
    for (long i = 0; i < each; ++i) {
      progress.show("placement, " + kinds[kind], i, each);
      const PlacementTrial trial = make_placement_trial(kind, random);
      query.evaluate(request_for(trial), result);
      placements[kind].add(compare(trial, result.placement));
      clearances[kind].add(compare_clearance(clearance_of(trial, random), query));
    }
  }
  print_table("axis, closed organ", kinds, placements);
  print_table("its clearance", kinds, clearances);
  return is_right(sum_of(placements)) && sum_of(clearances).get("wrong") == 0.0;
}

}  // namespace organ_collision::oracle
