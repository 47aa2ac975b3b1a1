#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <iomanip>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "exactness_proof.hpp"
#include "link_trials.hpp"
#include "query/grasp.hpp"

namespace organ_collision::oracle {

namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Translation3d;
using Eigen::Vector3d;

// Lengths in metres. The jaws close along z, around the origin, and reach it along x.

struct Tissue {
  std::vector<float> vertices;
  std::vector<std::uint32_t> triangles;

  /// Adds an open grid. `at`: its point at two coordinates in [0, 1].
  void add_grid(int across, int along, const std::function<Vector3d(double, double)>& at) {
    const auto first = static_cast<std::uint32_t>(vertices.size() / 3);
    const auto corner = [&](int i, int k) {
      return first + static_cast<std::uint32_t>(i * (along + 1) + k);
    };
    for (int i = 0; i <= across; ++i) {
      for (int k = 0; k <= along; ++k) {
        const Vector3d point = at(1.0 * i / across, 1.0 * k / along);
        for (const double x : point) vertices.push_back(static_cast<float>(x));
        if (i == across || k == along) continue;
        for (const auto& [a, b] : {std::pair(0, 1), std::pair(1, 0)}) {
          triangles.insert(triangles.end(),
                           {corner(i, k), corner(i + 1, k + a), corner(i + b, k + 1)});
        }
      }
    }
  }
};

/// Two layers, from `left` to `right` along x, whose surfaces are `bumps` high.
Tissue layers(double thickness, double left, double right, double bumps, int cells) {
  Tissue tissue;
  for (const double side : {-0.5, 0.5}) {
    tissue.add_grid(cells, cells, [&](double u, double v) {
      const double x = left + u * (right - left), y = 0.04 * (v - 0.5);
      const double bump = bumps * std::sin(2100.0 * x) * std::cos(1900.0 * y);
      return Vector3d(x, y, side * thickness + bump);
    });
  }
  return tissue;
}

Tissue slab(double thickness) { return layers(thickness, -0.03, 0.03, 0.0, 12); }

Tissue edge(double thickness) {
  Tissue tissue = layers(thickness, -0.04, 0.0, 0.0, 10);
  tissue.add_grid(2, 10, [&](double u, double v) {
    return Vector3d(0.0, 0.04 * (v - 0.5), thickness * (u - 0.5));
  });
  return tissue;
}

/// One layer, folded around the y axis. The ridge points along x.
Tissue fold(double thickness) {
  Tissue tissue;
  tissue.add_grid(30, 10, [&](double u, double v) {
    const double turn = std::clamp((u - 0.4) / 0.2, 0.0, 1.0) * M_PI - M_PI / 2;
    const double straight = 0.03 * (std::max(0.0, 0.4 - u) + std::max(0.0, u - 0.6)) / 0.4;
    return Vector3d(0.5 * thickness * std::cos(turn) - straight, 0.04 * (v - 0.5),
                    0.5 * thickness * std::sin(turn));
  });
  return tissue;
}

/// A tube with a lumen, along y.
Tissue vessel(double thickness) {
  Tissue tissue;
  for (const double share : {0.5, 0.35}) {
    tissue.add_grid(16, 10, [&](double u, double v) {
      return Vector3d(share * thickness * std::cos(2 * M_PI * u), 0.05 * (v - 0.5),
                      share * thickness * std::sin(2 * M_PI * u));
    });
  }
  return tissue;
}

Tissue open_sheet(double) {
  Tissue tissue;
  tissue.add_grid(14, 10, [](double u, double v) {
    const double x = 0.06 * (u - 0.5);
    return Vector3d(x, 0.04 * (v - 0.5), 0.001 * std::sin(150.0 * x));
  });
  return tissue;
}

/// Its slopes have up to 21 degrees, so that no bump ends a grasp of jaws that are not oblique.
Tissue bumpy_slab(double thickness) {
  return layers(thickness, -0.02, 0.02, 0.06 * std::min(thickness, 0.003), 26);
}

/// The top of an organ like an egg.
Tissue convex_organ(double) {
  Tissue tissue;
  tissue.add_grid(14, 24, [](double u, double v) {
    const double polar = 0.01 + 0.49 * M_PI * u, around = 2 * M_PI * v;
    return Vector3d(0.035 * std::sin(polar) * std::cos(around),
                    0.030 * std::sin(polar) * std::sin(around), 0.035 * (std::cos(polar) - 1.0));
  });
  return tissue;
}

enum class Jaws { kClose, kSlide, kRest };
enum class Expected { kGrasp, kNothing, kAnything };

struct GraspKind {
  const char* name;
  Tissue (*tissue)(double thickness);
  Jaws jaws;
  double aside;  ///< how far from the origin the jaws may close, along x and y
  double tilt;   ///< [rad] how oblique they may be
  Expected expected;
};

constexpr GraspKind kKinds[] = {
    {"slab", slab, Jaws::kClose, 0.005, 0.03, Expected::kGrasp},
    {"slab, oblique", slab, Jaws::kClose, 0.01, 1.2, Expected::kAnything},
    {"edge", edge, Jaws::kClose, 0.012, 0.3, Expected::kAnything},
    {"fold", fold, Jaws::kClose, 0.005, 0.1, Expected::kAnything},
    {"fold, oblique", fold, Jaws::kClose, 0.01, 0.8, Expected::kAnything},
    {"vessel", vessel, Jaws::kClose, 0.0, 0.03, Expected::kGrasp},
    {"vessel, oblique", vessel, Jaws::kClose, 0.01, 0.8, Expected::kAnything},
    {"open sheet", open_sheet, Jaws::kClose, 0.005, 0.03, Expected::kAnything},
    {"bumps", bumpy_slab, Jaws::kSlide, 0.004, 0.03, Expected::kGrasp},
    {"bumps, oblique", bumpy_slab, Jaws::kSlide, 0.004, 0.8, Expected::kAnything},
    {"rests on convex", convex_organ, Jaws::kRest, 0.004, 0.1, Expected::kNothing},
    {"grazes", slab, Jaws::kRest, 0.01, 0.3, Expected::kNothing}};

/// A jaw around x, whose inner face is at z = 0.
LinkPart make_jaw(Random& random) {
  const Vector3d size(random.uniform(0.006, 0.02), random.uniform(0.002, 0.005),
                      random.uniform(0.001, 0.003));
  const Isometry3d middle(Translation3d(0.0, 0.0, 0.5 * size.z()));
  switch (random.integer(0, 3)) {
    case 0:
      return LinkPart::sphere(middle.translation(), 0.5 * size.z());
    case 1:
      return LinkPart::cylinder(middle * AngleAxisd(M_PI / 2, Vector3d::UnitY()), 0.5 * size.z(),
                                size.x());
    case 2:
      return LinkPart::box(middle, size);
    default: {  // the inner face and a ridge outside
      std::vector<Vector3d> corners;
      for (const auto& [x, y] : {std::pair(-0.5, -0.5), {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}) {
        corners.emplace_back(x * size.x(), y * size.y(), 0.0);
      }
      for (const double x : {-0.5, 0.5}) corners.emplace_back(x * size.x(), 0.0, size.z());
      return LinkPart::mesh({corners,
                             {{0, 2, 1},
                              {0, 3, 2},
                              {0, 1, 5},
                              {0, 5, 4},
                              {2, 3, 4},
                              {2, 4, 5},
                              {0, 4, 3},
                              {1, 2, 5}}});
    }
  }
}

double jaw_height(const LinkPart& jaw) {
  return 2.0 * jaw.radius + jaw.project_onto(Vector3d::UnitZ()).high -
         jaw.project_onto(Vector3d::UnitZ()).low;
}

using Poses = std::vector<std::vector<Isometry3d>>;

/// The jaws stand side by side on the tissue, which they enter by so little that nothing is between
/// them.
Poses resting(const GraspKind& kind, double thickness, const LinkPart& jaw, Random& random) {
  const double open = random.uniform(0.003, 0.007);
  const double deepest = 0.02 * jaw_height(jaw) * random.uniform(-1.0, 1.0);
  Isometry3d tool(random_turn(random.uniform(0.0, kind.tilt), random));
  tool.rotate(AngleAxisd(random.uniform(-M_PI, M_PI), Vector3d::UnitZ()));
  const Vector3d middle(random.uniform(-kind.aside, kind.aside),
                        random.uniform(-kind.aside, kind.aside), 0.0);
  Poses poses;
  for (const double up : {0.003, 0.001, 0.0, 0.0, 0.002, 0.05}) {
    poses.emplace_back();
    for (const double side : {-1.0, 1.0}) {
      Isometry3d at(tool.linear() * AngleAxisd(side * M_PI / 2, Vector3d::UnitY()));
      const Vector3d down = -at.linear().transpose().col(2);
      const Vector3d end = middle + tool * Vector3d(side * open, 0.0, 0.0);
      const double x = end.x() / 0.035, y = end.y() / 0.030;
      const double top = kind.tissue == convex_organ
                             ? 0.035 * (std::sqrt(1.0 - x * x - y * y) - 1.0)
                             : 0.5 * thickness;
      const double reach = jaw.project_onto(down).high + jaw.radius;
      at.translation() = Vector3d(end.x(), end.y(), top + reach + up - deepest);
      poses.back().push_back(at);
    }
  }
  return poses;
}

/// The poses of both jaws, one step after another. They close until each has entered the tissue by
/// less than its own half, and end apart from the tissue.
Poses closing(const GraspKind& kind, double thickness, const LinkPart& jaw, Random& random) {
  const Isometry3d turned(AngleAxisd(M_PI, Vector3d::UnitX()));
  const auto tilt = [&] { return random_turn(random.uniform(0.0, kind.tilt), random); };
  Isometry3d tool(tilt() * AngleAxisd(random.uniform(-M_PI, M_PI), Vector3d::UnitZ()));
  tool.translation() = Vector3d(random.uniform(-kind.aside, kind.aside),
                                random.uniform(-kind.aside, kind.aside), 0.0);
  const Isometry3d first(tilt()), second = turned * Isometry3d(tilt());
  const double wide = thickness + 0.03, tight = (kind.tissue == open_sheet ? 0.0 : thickness) -
                                                jaw_height(jaw) * random.uniform(0.2, 0.6);
  const int held = kind.jaws == Jaws::kSlide ? 15 : 2;
  Poses poses;
  for (int i = -4; i < held + 4; ++i) {
    const double open = 0.25 * std::max({0, -i, i - held + 1});
    const double gap = 0.5 * (tight + open * open * (wide - tight));
    Isometry3d at = tool;
    if (kind.jaws == Jaws::kSlide) at.translate(Vector3d(0.0002 * i, 0.0001 * i, 0.0));
    at.translate(random.point(2e-5));
    poses.push_back(
        {at * Translation3d(0.0, 0.0, gap) * first, at * Translation3d(0.0, 0.0, -gap) * second});
  }
  return poses;
}

/// All pairs, with angles in long doubles, as the comment of Grasp.msg defines them.
struct NaivePairs {
  /// The least distance of the pairs that oppose within an angle, even if that is smaller by
  /// `slack` [rad]; infinity: there is none.
  static long double least(const std::vector<JawContact>& first,
                           const std::vector<JawContact>& second, double degrees, double slack) {
    long double least = std::numeric_limits<long double>::infinity();
    for (const JawContact& a : first) {
      for (const JawContact& b : second) {
        if (angle(a, b) <= degrees * M_PIl / 180.0L - slack)
          least = std::min(least, distance(a, b));
      }
    }
    return least;
  }

  using Vector = Eigen::Matrix<long double, 3, 1>;
  static Vector between(const JawContact& a, const JawContact& b) {
    return b.on_organ.cast<long double>() - a.on_organ.cast<long double>();
  }
  static long double distance(const JawContact& a, const JawContact& b) {
    return between(a, b).norm();
  }
  static long double angle_of(const Vector& a, const Vector& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
  }
  /// [rad] The larger angle between a normal and the line between the contacts.
  static long double angle(const JawContact& a, const JawContact& b) {
    const Vector d = between(a, b), first = a.normal.cast<long double>(),
                 second = -b.normal.cast<long double>();
    if (d.norm() < 1e-6L) return angle_of(first, second);
    return std::max(angle_of(first, d), angle_of(second, d));
  }
};

/// Whether a pair is what the definition says, up to the rounding of doubles. At the limits of the
/// angle both answers are right.
bool is_right(const std::vector<JawContact>& first, const std::vector<JawContact>& second,
              bool grasped, const std::optional<OpposingPair>& found) {
  constexpr double kSlack = 1e-11;
  const double degrees = grasped ? 55.0 : 45.0;
  const long double certain = NaivePairs::least(first, second, degrees, kSlack);
  if (!found) return std::isinf(certain);
  const JawContact &a = first[found->first], &b = second[found->second];
  return NaivePairs::angle(a, b) <= degrees * M_PIl / 180.0L + kSlack &&
         std::abs(NaivePairs::distance(a, b) - found->distance) <= 1e-15 &&
         found->distance <= certain + 1e-15;
}

class GraspProof {
 public:
  GraspProof(PickerKind picker, Random& random) : query_(picker), random_(random) {}

  /// Closes two jaws on tissue and opens them again.
  Tally close(const GraspKind& kind) {
    const double thickness = random_.scale(0.001, 0.03);
    const Tissue tissue = kind.tissue(thickness);
    const TriangleMesh organ(tissue.vertices, tissue.triangles);
    const LinkPart jaw = make_jaw(random_);
    const std::vector<Link> links = {{"first", {jaw}}, {"second", {jaw}}};
    const bool must = kind.expected == Expected::kGrasp;
    Tally tally;
    tally.count("closings", 1);
    long grasps = 0;
    bool grasped = false, is_wrong = false;
    std::vector<Isometry3d> before;
    const Poses all = kind.jaws == Jaws::kRest ? resting(kind, thickness, jaw, random_)
                                               : closing(kind, thickness, jaw, random_);
    for (const std::vector<Isometry3d>& poses : all) {
      const auto [first, second] = contacts_of(organ, links, before, poses);
      before = poses;
      const auto found = grasped_pair(first, second, grasped);
      tally.count("pairs", static_cast<long>(first.size() * second.size()));
      tally.count("steps", 1);
      grasps += found && !grasped;
      is_wrong = is_wrong || !is_right(first, second, grasped, found);
      if (must && found && kind.tissue == slab) is_wrong |= found->distance < thickness - 1e-8;
      grasped = found.has_value();
    }
    const bool is_expected = kind.expected == Expected::kAnything || grasps == (must ? 1 : 0);
    tally.count("grasps", grasps);
    tally.count("wrong", is_wrong);
    tally.count("not as expected", !is_expected);
    return tally;
  }

 private:
  using TwoSides = std::pair<std::vector<JawContact>, std::vector<JawContact>>;

  TwoSides contacts_of(const TriangleMesh& organ, const std::vector<Link>& links,
                       const std::vector<Isometry3d>& before, const std::vector<Isometry3d>& now) {
    CollisionRequest request;
    request.organ = &organ;
    request.links = &links;
    const ShaftAxis none{Vector3d::Zero(), Vector3d::Zero()};
    request.path = {{0.0, none, now}};
    if (!before.empty() && random_.chance(0.5)) {
      request.mode = QueryMode::kSwept;
      request.path = {{0.0, none, before}, {1.0, none, now}};
    }
    query_.evaluate(request, result_);
    TwoSides sides;
    for (const FaceContact& contact : result_.contacts) {
      if (!contact.touching) continue;
      (contact.link == 0 ? sides.first : sides.second)
          .push_back({contact.on_organ, contact.normal});
    }
    return sides;
  }

  CollisionQuery query_;
  CollisionResult result_;
  Random& random_;
};

/// Contacts of any kind, without jaws: clusters, the same places, angles at the limits.
Tally compare_scattered(Random& random) {
  const double size = random.scale(1e-6, 0.1);
  const Vector3d line = random.direction();
  const auto contacts = [&](double side) {
    std::vector<JawContact> made(static_cast<std::size_t>(random.scale(1.0, 200.0)));
    for (JawContact& contact : made) {
      const double turn = random.chance(0.5) ? random.uniform(0.0, M_PI)
                                             : (random.chance(0.5) ? 45.0 : 55.0) * M_PI / 180.0;
      contact.normal =
          side * (AngleAxisd(turn, random.direction().cross(line).normalized()) * line);
      contact.on_organ = random.point(size) - side * random.uniform(0.0, 2.0) * size * line;
      if (random.chance(0.2)) contact.on_organ = made.front().on_organ;
      if (random.chance(0.1)) contact.on_organ = Vector3d::Zero();
    }
    return made;
  };
  const std::vector<JawContact> first = contacts(1.0), second = contacts(-1.0);
  Tally tally;
  for (const bool grasped : {false, true}) {
    const auto found = grasped_pair(first, second, grasped);
    tally.count("closings", 1);
    tally.count("pairs", static_cast<long>(first.size() * second.size()));
    tally.count("grasps", found.has_value());
    tally.count("wrong", !is_right(first, second, grasped, found));
  }
  return tally;
}

bool is_right(const Tally& tally) {
  return tally.get("wrong") == 0.0 && tally.get("not as expected") == 0.0;
}

}  // namespace

bool prove_grasps(const ProofSize& size, Progress& progress) {
  std::vector<std::string> names = names_of(kKinds);
  names.emplace_back("scattered");
  const long each = size.pairs / 10 / static_cast<long>(names.size()) + 1;
  std::vector<Tally> tallies(names.size());
  for (std::size_t kind = 0; kind < names.size(); ++kind) {
    Random random(1000 * size.seed + kind);
    GraspProof proof(size.pickers.front(), random);
    for (long i = 0; i < each; ++i) {
      progress.show("grasps, " + names[kind], i, each);
      const bool closes = kind < std::size(kKinds);
      const Tally tally = closes ? proof.close(kKinds[kind]) : compare_scattered(random);
      if (!is_right(tally)) {  // The seed and the number repeat it.
        std::cout << "grasps differ: " << names[kind] << ", closing " << i << ", seed " << size.seed
                  << std::endl;
      }
      tallies[kind].add(tally);
    }
  }
  print_table("jaws and tissue", names, tallies);
  return is_right(sum_of(tallies));
}

}  // namespace organ_collision::oracle
