#include <string>
#include <vector>

#include "clearance_comparison.hpp"
#include "placement_comparison.hpp"
#include "proofs.hpp"

namespace organ_collision::oracle {
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
