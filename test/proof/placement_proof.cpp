#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <string>
#include <vector>

#include "clearance_proof.hpp"
#include "exact_sides.hpp"
#include "exactness_proof.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "placement_trials.hpp"

namespace organ_collision::oracle {

/// Counts how the library's sides and crossings compare with exact arithmetic.
struct PlacementTally {
  long pairs = 0;
  long inside = 0;       ///< tips inside
  long on_surface = 0;   ///< tips exactly on a face
  long crossings = 0;    ///< according to the oracle
  long wrong_sides = 0;  ///< of tips and trocars
  long missed = 0;       ///< crossings that the library does not have
  long superfluous = 0;  ///< crossings that the oracle does not have, or that occur twice
  long wrong = 0;        ///< answers with another difference beyond 1e-9 m
  double place = 0.0;    ///< [m] largest error of a crossing's place on the axis
  double length = 0.0;   ///< [m] largest error of the length inside

  bool is_right() const {
    return wrong_sides == 0 && missed == 0 && superfluous == 0 && wrong == 0;
  }
  void add(const PlacementTally& other);
};

/// Prints the head of a table, and one line of it, in Markdown.
void print_placement_head(const std::string& what);
void print(const std::string& name, const PlacementTally& tally);

/// Asks the library and exact arithmetic where a tool is. Prints every trial in which they differ.
class PlacementComparison {
 public:
  PlacementTally compare(const PlacementTrial& trial);

 private:
  CollisionQuery query_;
  CollisionResult result_;
};

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

void compare_crossings(const PlacementTrial& trial, const std::vector<ExactCrossing>& exact,
                       const std::vector<AxisCrossing>& found, double band, PlacementTally& tally) {
  const double length = (trial.axis.tip - trial.axis.trocar).norm();
  std::vector<bool> is_found(exact.size(), false);
  double last = 0.0;
  for (const AxisCrossing& crossing : found) {
    const auto same = std::find_if(exact.begin(), exact.end(), [&](const ExactCrossing& other) {
      return other.face == crossing.face && other.direction == crossing.direction;
    });
    const auto index = static_cast<std::size_t>(same - exact.begin());
    if (same == exact.end() || is_found[index]) {
      ++tally.superfluous;
      continue;
    }
    is_found[index] = true;
    const double error = std::abs(crossing.shaft - same->shaft) * length;
    tally.place = std::max(tally.place, error);
    const bool in_order = same->shaft * length >= last - band;
    last = std::max(last, same->shaft * length);
    if (error > band || !in_order || !is_consistent(crossing, trial, band)) tally.wrong = 1;
  }
  tally.missed = std::count(is_found.begin(), is_found.end(), false);
}

}  // namespace

void PlacementTally::add(const PlacementTally& other) {
  pairs += other.pairs;
  inside += other.inside;
  on_surface += other.on_surface;
  crossings += other.crossings;
  wrong_sides += other.wrong_sides;
  missed += other.missed;
  superfluous += other.superfluous;
  wrong += other.wrong;
  place = std::max(place, other.place);
  length = std::max(length, other.length);
}

void print_placement_head(const std::string& what) {
  std::cout << "\n| " << std::left << std::setw(18) << what
            << " |     pairs | tips inside | on a face | crossings | wrong sides | missed | "
               "superfluous | otherwise wrong | place off by [m] | length off by [m] |\n"
            << "|---|---|---|---|---|---|---|---|---|---|---|\n";
}

void print(const std::string& name, const PlacementTally& tally) {
  std::cout << "| " << std::left << std::setw(18) << name << std::right;
  for (const long count : {tally.pairs, tally.inside, tally.on_surface, tally.crossings,
                           tally.wrong_sides, tally.missed, tally.superfluous, tally.wrong}) {
    std::cout << " | " << std::setw(9) << count;
  }
  for (const double error : {tally.place, tally.length}) {
    std::cout << " | " << std::setw(9) << std::setprecision(2) << error;
  }
  std::cout << " |" << std::endl;
}

PlacementTally PlacementComparison::compare(const PlacementTrial& trial) {
  query_.evaluate(request_for(trial), result_);
  const AxisPlacement& found = result_.placement;
  const ExactPlacement exact = exact_placement(trial);
  const double band = kBand + 1e-15 * largest_coordinate(trial.organ);

  PlacementTally tally;
  tally.pairs = 1;
  tally.inside = exact.tip == Side::kInside;
  tally.on_surface = exact.tip == Side::kOnSurface;
  tally.crossings = static_cast<long>(exact.crossings.size());
  tally.wrong_sides = (found.tip != exact.tip) + (found.trocar != exact.trocar);
  compare_crossings(trial, exact.crossings, found.crossings, band, tally);
  tally.length = std::abs(found.length_inside - exact.length_inside);
  if (!found.length_known || tally.length > band) tally.wrong = 1;
  if (!tally.is_right()) {
    std::cout << "placement differs: tip " << static_cast<int>(found.tip) << " instead of "
              << static_cast<int>(exact.tip) << ", trocar " << static_cast<int>(found.trocar)
              << " instead of " << static_cast<int>(exact.trocar) << ", " << found.crossings.size()
              << " crossings instead of " << exact.crossings.size() << '\n'
              << trial << std::endl;
  }
  return tally;
}

namespace {

ClearanceTrial clearance_of(const PlacementTrial& trial, Random& random) {
  return {{trial.organ, trial.organ, resting_path({trial.axis, {}}), random.scale(1e-4, 1e-2), {}},
          0.0};
}

}  // namespace

bool prove_placement(long pairs, unsigned long seed, Progress& progress) {
  const std::vector<std::string>& kinds = placement_trial_kinds();
  const long each = pairs / static_cast<long>(kinds.size()) + 1;
  PlacementComparison comparison;
  ClearanceComparison clearance_comparison;
  std::vector<PlacementTally> placements(kinds.size());
  std::vector<ClearanceTally> clearances(kinds.size());
  PlacementTally all;
  ClearanceTally all_clearances;
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    Random random(1000 * seed + kind);
    for (long i = 0; i < each; ++i) {
      progress.show("placement, " + kinds[kind], i, each);
      const PlacementTrial trial = make_placement_trial(kind, random);
      placements[kind].add(comparison.compare(trial));
      clearances[kind].add(clearance_comparison.compare(clearance_of(trial, random)));
    }
    all.add(placements[kind]);
    all_clearances.add(clearances[kind]);
  }
  print_placement_head("axis, closed organ");
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) print(kinds[kind], placements[kind]);
  print("all", all);
  print_clearance_head("its clearance");
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) print(kinds[kind], clearances[kind]);
  print("all", all_clearances);
  return all.is_right() && all_clearances.wrong == 0;
}

}  // namespace organ_collision::oracle
