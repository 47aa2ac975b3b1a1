#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "exact_distance.hpp"
#include "exact_sides.hpp"
#include "exactness_proof.hpp"
#include "geometry/distance/first_touch.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "picking/pickers/picker.hpp"
#include "picking/volumes/paper_volumes.hpp"
#include "picking/volumes/viewing_volume.hpp"
#include "step_oracle.hpp"
#include "trials.hpp"

namespace organ_collision::oracle {

/// The largest difference between an answer and the exact one that rounding may explain [m].
inline constexpr double kBand = 1e-9;

/// Asks the library and the oracles the same questions. Prints every trial in which they differ by
/// more than the tolerance.
class Comparison {
 public:
  Comparison();

  /// Compares with exact distances: the tool at rest at the end of its motion, or swept. If the
  /// library or the oracle says that the face touches, all pickers must find it.
  Tally at_rest(const Trial& trial);
  Tally swept(const Trial& trial);

  /// Compares what all pickers find with the exact half-spaces of a volume.
  Tally volume(const ViewingVolume& volume, const Trial& trial);

  /// Compares the whole query with a search, while the face and the trocar move, too.
  Tally moving(const Trial& trial, Random& random);

 private:
  Tally capsule(const ShaftMotion& motion, const Trial& trial);

  std::vector<std::unique_ptr<Picker>> pickers_;  ///< one of each kind
  CollisionQuery query_;
};

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
