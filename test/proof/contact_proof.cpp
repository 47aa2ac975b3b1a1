#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "exact_distance.hpp"
#include "exact_sides.hpp"
#include "exactness_proof.hpp"
#include "geometry/distance/first_touch.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "picking/pickers/picker.hpp"
#include "picking/volumes/paper_volumes.hpp"
#include "step_oracle.hpp"

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;

/// [m] The largest difference between an answer and the exact one that rounding may explain.
constexpr double kBand = 1e-9;

constexpr char kWrong[] = "differ by more";
constexpr char kMissed[] = "missed";

/// The largest coordinate of the face relative to `origin` [m].
double extent(const Triangle& face, const Vector3d& origin) {
  double largest = 0.0;
  for (const Vector3d& corner : face) {
    largest = std::max(largest, (corner - origin).cwiseAbs().maxCoeff());
  }
  return largest;
}

bool picks(Picker& picker, const ViewingVolume& volume, const TriangleMesh& mesh) {
  std::vector<Candidate> candidates;
  picker.pick(volume, mesh, candidates);
  picker.release();
  return !candidates.empty();
}

Tally new_tally(bool touching) {
  Tally tally;
  tally.count("pairs", 1);
  tally.count("touching", touching);
  return tally;
}

/// Counts a difference that rounding explains, or prints the trial.
void count_difference(const char* what, bool explained, const Trial& trial, Tally& tally) {
  tally.count("differ by rounding", explained);
  tally.count(kWrong, !explained);
  if (!explained) std::cout << what << ": " << to_line(trial) << std::endl;
}

/// Asks the library and the oracles the same questions.
class Comparison {
 public:
  explicit Comparison(const std::vector<PickerKind>& kinds) : query_(kinds.front()) {
    for (const PickerKind kind : kinds) pickers_.push_back(make_picker(kind));
  }

  /// Compares with exact distances, which also tell whether a touch is too late. If the library or
  /// the oracle says that the face touches, all pickers must find it.
  Tally capsule(const ShaftMotion& motion, const Trial& trial) {
    const bool touching = within(core(motion), trial.face, trial.radius);
    const auto touch = first_touch(motion, {trial.face, trial.face}, trial.radius);
    const bool found = touch.has_value();
    Tally tally = new_tally(touching);
    if (found && touch->time > 0.0) {
      const ShaftMotion before{motion.start, motion.at(touch->time)};
      const bool is_late = within(core(before), trial.face, trial.radius - kBand);
      if (is_late) count_difference("touches too late", false, trial, tally);
    }
    if (touching != found) {
      const double off = std::abs(distance(core(motion), trial.face) - trial.radius);
      count_difference("differs from exact distance", off <= kBand, trial, tally);
      tally.keep_most("by at most [m]", off);
    }
    if (!touching && !found) return tally;
    const double largest = extent(trial.face, motion.start.trocar);
    const ViewingVolume volume = PartSweep(motion, trial.radius).volume({0.0, largest});
    const TriangleMesh mesh = mesh_of({trial.face});
    for (const std::unique_ptr<Picker>& picker : pickers_) {
      if (picks(*picker, volume, mesh)) continue;
      tally.count(kMissed, 1);
      std::cout << "missed by a picker: " << to_line(trial) << std::endl;
    }
    return tally;
  }

  /// Compares what all pickers find with the exact half-spaces of a volume.
  Tally volume(const ViewingVolume& volume, const Trial& trial) {
    const double largest = extent(trial.face, volume.origin());
    const auto inside = [&](double share) {
      return meets(trial.face, volume.origin(), half_spaces(volume, largest, share));
    };
    const bool exact = inside(0.0), surely = inside(-1.0), maybe = inside(1.0);
    const TriangleMesh mesh = mesh_of({trial.face});
    Tally tally = new_tally(exact);
    for (const std::unique_ptr<Picker>& picker : pickers_) {
      const bool picked = picks(*picker, volume, mesh);
      if (picked == exact) continue;
      count_difference("differs from exact half-spaces", picked ? maybe : !surely, trial, tally);
    }
    return tally;
  }

  /// Compares the whole query with a search, while the face and the trocar move, too.
  Tally moving(const Trial& trial, Random& random) {
    constexpr double kSlack = 1e-9;  // [m]
    ShaftMotion motion = trial.motion;
    motion.start.trocar += random.scale(1e-4, 0.05) * random.direction();
    FaceMotion face{trial.face, trial.face};
    for (Vector3d& corner : face.start) corner += random.scale(1e-4, 0.05) * random.direction();
    face.start = rounded(face.start);

    const TriangleMesh organ = mesh_of({face.end}), before = mesh_of({face.start});
    CollisionRequest request;
    request.organ = &organ;
    request.organ_before = &before;
    request.path = {{0.0, motion.start}, {1.0, motion.end}};
    request.radius = trial.radius;
    request.mode = QueryMode::kSwept;
    query_.evaluate(request, result_);

    const FirstTime first = first_time_within(motion, face, trial.radius, kSlack);
    const bool found = !result_.contacts.empty();
    Tally tally = new_tally(first.certainly.has_value());
    const bool is_missed = !found && first.certainly;
    tally.count(kMissed, is_missed);
    bool wrong = is_missed || (found && !first.possibly);
    if (found && first.possibly) {
      const double time = result_.contacts[0].fraction;
      wrong = time < *first.possibly - kBand || time > first.certainly.value_or(1.0) + kBand;
    }
    if (wrong) count_difference("differs from search", false, trial, tally);
    return tally;
  }

 private:
  std::vector<std::unique_ptr<Picker>> pickers_;
  CollisionQuery query_;
  CollisionResult result_;
};

using Tallies = std::map<std::string, Tally>;

/// Compares our volume and those of the paper's volumes that exist for the motion.
void compare_volumes(const Trial& trial, Comparison& comparison, Tallies& tallies) {
  const ShaftMotion& motion = trial.motion;
  const auto compare = [&](const char* name, const ViewingVolume& volume) {
    tallies[name].add(comparison.volume(volume, trial));
  };
  compare("the tool's", PartSweep(motion, trial.radius).tool_volume());
  if (motion.end.tip == motion.end.trocar) return;
  compare("paper's static", paper_static_volume(motion.end, trial.radius));
  if (motion.start.tip == motion.start.trocar) return;
  compare("paper's swept", paper_swept_volume(motion, trial.radius));
  compare("paper's naive", paper_naive_volume(motion, trial.radius));
}

}  // namespace

bool prove_contacts(const ProofSize& size, Progress& progress) {
  std::vector<std::string> kinds = trial_kinds();
  const long each = (size.pairs - 1) / static_cast<long>(kinds.size()) + 1;
  kinds.emplace_back("once wrong");
  Comparison comparison(size.pickers);
  std::vector<Tally> at_rest(kinds.size()), swept(kinds.size()), moving(kinds.size());
  Tallies volumes;
  const std::string data = ORGAN_COLLISION_TEST_DATA;
  for (const char* const file : {"/first_touch_trials.txt", "/picker_trials.txt"}) {
    for (const Trial& trial : read_trials(data + file)) {
      at_rest.back().add(comparison.capsule({trial.motion.end, trial.motion.end}, trial));
      swept.back().add(comparison.capsule(trial.motion, trial));
    }
  }
  for (std::size_t kind = 0; kind < trial_kinds().size(); ++kind) {
    Random random(1000 * size.seed + kind);
    for (long i = 0; i < each; ++i) {
      progress.show(kinds[kind], i, each);
      const Trial trial = make_trial(kind, random);
      at_rest[kind].add(comparison.capsule({trial.motion.end, trial.motion.end}, trial));
      swept[kind].add(comparison.capsule(trial.motion, trial));
      if (i % 20 == 0) compare_volumes(trial, comparison, volumes);
      if (i < 10 || i % 200 == 0) moving[kind].add(comparison.moving(trial, random));
    }
  }
  std::vector<std::string> volume_names;
  std::vector<Tally> of_volumes;
  for (const auto& [name, tally] : volumes) {
    volume_names.push_back(name);
    of_volumes.push_back(tally);
  }
  Tally all = sum_of(of_volumes);
  for (const std::vector<Tally>* const tallies : {&at_rest, &swept, &moving}) {
    all.add(sum_of(*tallies));
  }
  print_table("capsule at rest", kinds, at_rest);
  print_table("capsule swept", kinds, swept);
  print_table("everything moves", kinds, moving);
  print_table("volume", volume_names, of_volumes);
  return all.get(kWrong) == 0.0 && all.get(kMissed) == 0.0;
}

namespace {

constexpr double kRadius = 5e-3;  // [m]

/// A unit vector: the direction of the tip's motion, for a tool along `axis`.
Vector3d step_direction(const std::string& name, const Vector3d& axis, Random& random) {
  const Vector3d along = axis.normalized();
  const Vector3d any = random.direction();
  const Vector3d across = (any - any.dot(along) * along).normalized();
  if (name == "sideways") return across;
  if (name == "oblique") return (across + random.sign() * along).normalized();
  if (name == "along the axis") return random.sign() * along;
  return any;
}

/// Small faces, within two radii of the axis.
TriangleMesh faces_near(const ShaftMotion& motion, Random& random) {
  std::vector<Triangle> faces(500);
  for (Triangle& face : faces) {
    const Vector3d center = motion.at(random.uniform(0.0, 1.0)).at(random.uniform(0.0, 1.0)) +
                            random.uniform(0.0, 2.0 * kRadius) * random.direction();
    for (Vector3d& corner : face) corner = center + 2e-3 * random.direction();
  }
  return mesh_of(faces);
}

std::vector<bool> found_by(CollisionQuery& query, const TriangleMesh& organ,
                           const ShaftMotion& motion, QueryMode mode) {
  CollisionRequest request;
  request.organ = &organ;
  request.path = {{0.0, motion.start}, {1.0, motion.end}};
  request.radius = kRadius;
  request.mode = mode;
  CollisionResult result;
  query.evaluate(request, result);
  std::vector<bool> faces(organ.face_count());
  for (const FaceContact& contact : result.contacts) faces[contact.face] = true;
  return faces;
}

}  // namespace

bool count_paper_misses(const ProofSize& size, Progress& progress) {
  constexpr int kMotions = 40;
  CollisionQuery query(size.pickers.front());
  Random random(size.seed);
  std::vector<std::string> names;
  std::vector<Tally> tallies;
  for (const char* const name : {"sideways", "random", "along the axis", "oblique"}) {
    for (const int step : {0, 1, 5, 20, 50, 100, 200}) {  // [mm]
      Tally tally;
      for (int i = 0; i < kMotions; ++i) {
        progress.show(name, i, kMotions);
        const Vector3d trocar = random.point(0.05);
        const Vector3d previous = trocar + random.uniform(0.1, 0.2) * random.direction();
        const Vector3d along = step_direction(name, previous - trocar, random);
        const ShaftMotion motion{{trocar, previous}, {trocar, previous + 1e-3 * step * along}};
        const TriangleMesh organ = faces_near(motion, random);
        const std::vector<bool> by_paper = found_by(query, organ, motion, QueryMode::kPaperSwept);
        const std::vector<bool> by_us = found_by(query, organ, motion, QueryMode::kSwept);
        for (std::size_t face = 0; face < organ.face_count(); ++face) {
          const Triangle triangle = organ.triangle(face);
          if (!within(core(motion), triangle, kRadius)) continue;
          tally.count("touched faces", 1);
          tally.count("missed by the paper's volume", !by_paper[face]);
          tally.keep_most(
              "of it, deepest [mm]",
              by_paper[face] ? 0.0 : 1e3 * (kRadius - distance(core(motion), triangle)));
          tally.count("missed by ours", !by_us[face]);
        }
      }
      names.push_back(name + (", " + std::to_string(step)) + " mm");
      tallies.push_back(tally);
    }
  }
  print_table("motion, step", names, tallies);
  return sum_of(tallies).get("missed by ours") == 0.0;
}

}  // namespace organ_collision::oracle
