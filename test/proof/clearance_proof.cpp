#include <functional>
#include <string>
#include <vector>

#include "clearance_comparison.hpp"
#include "link_trials.hpp"
#include "proofs.hpp"

namespace organ_collision::oracle {
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
