#include <map>
#include <string>
#include <utility>
#include <vector>

#include "comparison.hpp"
#include "picking/volumes/paper_volumes.hpp"
#include "proofs.hpp"

namespace organ_collision::oracle {
namespace {

using Tallies = std::map<std::string, Tally>;

/// Compares our volume and those of the paper's volumes that exist for the motion.
void compare_volumes(const Trial& trial, Comparison& comparison, Tallies& tallies) {
  const ShaftMotion& motion = trial.motion;
  const auto compare = [&](const char* name, const ViewingVolume& volume) {
    tallies[name].add(comparison.volume(volume, trial));
  };
  compare("the tool's", tool_volume(motion, trial.radius));
  if (motion.end.tip == motion.end.trocar) return;
  compare("paper's static", paper_static_volume(motion.end, trial.radius));
  if (motion.start.tip == motion.start.trocar) return;
  compare("paper's swept", paper_swept_volume(motion, trial.radius));
  compare("paper's naive", paper_naive_volume(motion, trial.radius));
}

}  // namespace

bool prove_contacts(long pairs, unsigned long seed, Progress& progress) {
  const std::vector<std::string>& kinds = trial_kinds();
  const long each = (pairs + static_cast<long>(kinds.size()) - 1) / static_cast<long>(kinds.size());
  Comparison comparison;
  std::vector<Tally> at_rest(kinds.size()), swept(kinds.size()), moving(kinds.size());
  Tallies volumes;
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    Random random(1000 * seed + kind);
    for (long i = 0; i < each; ++i) {
      progress.show(kinds[kind], i, each);
      const Trial trial = make_trial(kind, random);
      at_rest[kind].add(comparison.at_rest(trial));
      swept[kind].add(comparison.swept(trial));
      if (i % 20 == 0) compare_volumes(trial, comparison, volumes);
      if (i % 200 == 0) moving[kind].add(comparison.moving(trial, random));
    }
  }

  Tally all;
  const auto print_all = [&](const std::string& what, const std::string& band,
                             const std::vector<Tally>& tallies) {
    print_head(what, band);
    Tally sum;
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
      print(kinds[kind], tallies[kind]);
      sum.add(tallies[kind]);
    }
    print("all", sum);
    all.add(sum);
  };
  print_all("capsule at rest", "1e-9 m", at_rest);
  print_all("capsule swept", "1e-9 m", swept);
  print_all("everything moves", "1e-6 m", moving);
  print_head("volume", "32 bits");
  for (const auto& [name, tally] : volumes) {
    print(name, tally);
    all.add(tally);
  }
  return all.outside_band == 0 && all.missed == 0;
}

}  // namespace organ_collision::oracle
