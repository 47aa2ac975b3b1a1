#include <Eigen/Geometry>
#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>
#include <functional>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "exactness_proof.hpp"
#include "link_trials.hpp"
#include "node/publishing/touch_tracker.hpp"

namespace organ_collision::oracle {

namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Translation3d;
using Eigen::Vector3d;
using Poses = std::vector<Isometry3d>;

// Lengths in metres. The jaws close along z of the tool, and reach along its x.

/// An answer OK, with all that the definition in Grasp.msg speaks of.
struct Answered {
  struct Touch {
    std::uint32_t face;
    Vector3d at, n;
  };
  struct Nearest {
    Touch first, second;
    double distance;
  };

  std::int64_t stamp;
  bool same_triangles;
  Poses poses;
  double width;  ///< between the centres of the jaws' boxes
  std::vector<Touch> touches[2];
  std::optional<Nearest> begins, holds;  ///< the pair that opposes, for both limits
};

/// The definition, word by word, over all answers since the last end with a reason.
class GraspOracle {
 public:
  GraspOracle(double gap, std::int64_t hold) : gap_(gap), hold_(hold) {}

  /// "", "grasped", "opened" or "slipped".
  std::string add(Answered answer) {
    all_.push_back(std::move(answer));
    const std::size_t now = all_.size() - 1;
    all_[now].begins = opposing(45.0, gap_);
    all_[now].holds = opposing(55.0, 1.5 * gap_);
    return grasped_ ? released(now) : grasped(now);
  }
  const Answered& last_opposed() const { return all_[last_]; }
  bool is_grasped() const { return grasped_.has_value(); }
  std::int64_t duration() const { return all_[last_].stamp - began_; }

 private:
  using Nearest = Answered::Nearest;

  std::string grasped(std::size_t now) {
    if (now == 0 || !all_[now].begins || !all_[now - 1].begins || !all_[now].same_triangles)
      return "";
    if (opened_) {
      bool was_without = false;
      for (std::size_t i = opened_->second; i < now; ++i) was_without |= !all_[i].begins;
      const double apart = carried(opened_->first, now);
      if (!was_without && apart >= 2.0 * all_[opened_->first].holds->distance) return "";
    }
    opened_.reset();
    grasped_ = last_ = now;
    began_ = all_[now].stamp;
    all_[now].holds = all_[now].begins;
    return "grasped";
  }

  std::string released(std::size_t now) {
    std::size_t thinnest = *grasped_, without = now + 1;
    double least = carried(*grasped_, now);
    for (std::size_t i = *grasped_; i <= now; ++i) {
      least = std::min(least, carried(*grasped_, i));
      if (all_[i].holds) {
        last_ = i;
        if (all_[i].holds->distance < all_[thinnest].holds->distance) thinnest = i;
        without = now + 1;
      } else if (without > now) {
        without = i;
      }
    }
    const double apart = carried(thinnest, now), width = carried(*grasped_, now);
    const bool lost = without < now && all_[now].stamp - all_[without].stamp >= hold_;
    const bool open = apart > 2.0 * all_[thinnest].holds->distance && apart > 0.001;
    if (!lost && !open) return "";
    grasped_.reset();
    if (open) opened_ = {thinnest, now};
    return open || (width - least > 0.0002 && width > 1.05 * least) ? "opened" : "slipped";
  }

  /// How far apart the places of the pair of one answer are in another one.
  double carried(std::size_t from, std::size_t to) const {
    const Nearest& pair = *all_[from].holds;
    Vector3d a = pair.first.at, b = pair.second.at;
    if (is_one_face(pair.first, pair.second)) a = b = (a + b) / 2;
    const auto move = [&](std::size_t jaw, const Vector3d& place) -> Vector3d {
      return all_[to].poses[jaw] * (all_[from].poses[jaw].inverse() * place);
    };
    return (move(1, b) - move(0, a)).norm();
  }

  static bool is_one_face(const Answered::Touch& a, const Answered::Touch& b) {
    return a.face == b.face && a.n.dot(b.n) < 0.0;
  }

  /// Of the last answer.
  std::optional<Nearest> opposing(double degrees, double gap) const {
    const Answered& now = all_.back();
    const Poses* widest = widest_poses();
    std::optional<Nearest> best;
    for (const auto& a : now.touches[0]) {
      for (const auto& b : now.touches[1]) {
        const Vector3d d = b.at - a.at;
        double distance = d.norm();
        const auto angle = [](const Vector3d& u, const Vector3d& v) {
          return std::atan2(u.cross(v).norm(), u.dot(v)) * 180.0 / M_PI;
        };
        bool opposes = distance < 1e-6 ? angle(a.n, -b.n) <= degrees
                                       : angle(a.n, d) <= degrees && angle(-b.n, d) <= degrees;
        if (a.n.isZero() || b.n.isZero()) opposes = false;
        if (is_one_face(a, b)) distance = 0.0, opposes = true;
        if (!opposes && widest && gap_ > 0.0 && distance <= gap) {
          const Vector3d first = (*widest)[0] * (now.poses[0].inverse() * a.at);
          const Vector3d second = (*widest)[1] * (now.poses[1].inverse() * b.at);
          opposes = (second - first).norm() > 2.0 * gap_;
        }
        if (opposes && (!best || distance < best->distance)) best = {a, b, distance};
      }
    }
    return best;
  }

  /// The poses in which the jaws were widest since both touch; null: they do not.
  const Poses* widest_poses() const {
    const Answered* widest = nullptr;
    std::optional<std::int64_t> apart;
    for (const Answered& answer : all_) {
      const bool both = !answer.touches[0].empty() && !answer.touches[1].empty();
      if (!both && !apart) apart = answer.stamp;
      if (!both) continue;
      if (apart && answer.stamp - *apart >= hold_) widest = nullptr;
      apart.reset();
      if (!widest || answer.width > widest->width) widest = &answer;
    }
    return widest ? &widest->poses : nullptr;
  }

  double gap_;
  std::int64_t hold_;
  std::vector<Answered> all_;
  std::size_t last_ = 0;
  std::int64_t began_ = 0;
  std::optional<std::size_t> grasped_;
  std::optional<std::pair<std::size_t, std::size_t>> opened_;
};

struct Tissue {
  std::vector<float> vertices;
  std::vector<std::uint32_t> triangles;

  /// A grid. `at`: its point at two coordinates in [0, 1].
  void add_grid(int across, int along, const std::function<Vector3d(double, double)>& at) {
    const auto first = static_cast<std::uint32_t>(vertices.size() / 3);
    const auto corner = [&](int i, int k) {
      return first + static_cast<std::uint32_t>(i * (along + 1) + k);
    };
    for (int i = 0; i <= across; ++i) {
      for (int k = 0; k <= along; ++k) {
        for (const double x : at(1.0 * i / across, 1.0 * k / along)) {
          vertices.push_back(static_cast<float>(x));
        }
        if (i == across || k == along) continue;
        for (const auto& [a, b] : {std::pair(0, 1), std::pair(1, 0)}) {
          triangles.insert(triangles.end(),
                           {corner(i, k), corner(i + 1, k + a), corner(i + b, k + 1)});
        }
      }
    }
  }

  /// The border of a box of cells, bent by `at`. Periodic: u = 0 is where u = 1 is.
  void add_solid(int across, int along, bool periodic,
                 const std::function<Vector3d(double, double, double)>& at) {
    add_grid(across, along, [&](double u, double v) { return at(u, v, 1.0); });
    add_grid(along, across, [&](double v, double u) { return at(u, v, 0.0); });
    add_grid(across, 1, [&](double u, double w) { return at(u, 0.0, w); });
    add_grid(1, across, [&](double w, double u) { return at(u, 1.0, w); });
    if (periodic) return;
    add_grid(1, along, [&](double w, double v) { return at(0.0, v, w); });
    add_grid(along, 1, [&](double v, double w) { return at(1.0, v, w); });
  }
};

Tissue slab(double thickness) {
  Tissue tissue;
  tissue.add_solid(20, 14, false, [&](double u, double v, double w) {
    return Vector3d(0.06 * (u - 0.5), 0.04 * (v - 0.5), thickness * (w - 0.5));
  });
  return tissue;
}

Tissue bumps(double thickness) {
  Tissue tissue;
  tissue.add_solid(24, 16, false, [&](double u, double v, double w) {
    const double x = 0.04 * (u - 0.5), y = 0.03 * (v - 0.5);
    const double bump =
        0.06 * std::min(thickness, 0.003) * std::sin(2100.0 * x) * std::cos(1900.0 * y);
    return Vector3d(x, y, thickness * (w - 0.5) + bump);
  });
  return tissue;
}

/// A layer of half the thickness, folded around the y axis. The ridge points along x.
Tissue fold(double thickness) {
  Tissue tissue;
  tissue.add_solid(40, 14, false, [&](double u, double v, double w) {
    const double turn = std::clamp((u - 0.4) / 0.2, 0.0, 1.0) * M_PI - M_PI / 2;
    const double straight = 0.03 * (std::max(0.0, 0.4 - u) + std::max(0.0, u - 0.6)) / 0.4;
    const double radius = thickness * (0.1 + 0.4 * w);
    return Vector3d(radius * std::cos(turn) - straight, 0.04 * (0.5 - v), radius * std::sin(turn));
  });
  return tissue;
}

constexpr double kLumen = 0.009;

/// Along x, around a lumen.
Tissue tube(double thickness) {
  Tissue tissue;
  // No face is turned by 45 or 55 degrees from a line that jaws may have between them.
  tissue.add_solid(22, 8, true, [&](double u, double v, double w) {
    const double turn = u < 1.0 ? 2.0 * M_PI * u : 0.0, radius = kLumen + 0.2 * thickness * w;
    return Vector3d(0.04 * (v - 0.5), radius * std::cos(turn), radius * std::sin(turn));
  });
  return tissue;
}

Tissue sheet(double) {
  Tissue tissue;
  tissue.add_grid(14, 10, [](double u, double v) {
    const double x = 0.06 * (u - 0.5);
    return Vector3d(x, 0.04 * (v - 0.5), 0.001 * std::sin(150.0 * x));
  });
  return tissue;
}

Tissue egg(double) {
  Tissue tissue;
  tissue.add_solid(14, 12, false, [](double u, double v, double w) {
    const Vector3d ball = Vector3d(2 * u - 1, 2 * v - 1, 2 * w - 1).normalized();
    return Vector3d(0.035 * ball.x(), 0.03 * ball.y(), 0.035 * ball.z() - 0.035);
  });
  return tissue;
}

enum class Way { kClose, kCloseOn, kInLumen, kSpread, kForceps, kWideForceps, kPoke };
enum class Expected { kGrasp, kNothing, kAnything };

struct GraspKind {
  const char* name;
  Tissue (*tissue)(double thickness);
  Way way;
  double tilt;  ///< [rad] how oblique the jaws may be
  Expected expected;
};

constexpr GraspKind kKinds[] = {
    {"slab", slab, Way::kClose, 0.03, Expected::kGrasp},
    {"slab, oblique", slab, Way::kClose, 1.2, Expected::kAnything},
    {"closes on", slab, Way::kCloseOn, 0.3, Expected::kAnything},
    {"fold", fold, Way::kClose, 0.03, Expected::kGrasp},
    {"fold, oblique", fold, Way::kCloseOn, 0.8, Expected::kAnything},
    {"tube", tube, Way::kClose, 0.8, Expected::kAnything},
    {"wall of a tube", tube, Way::kInLumen, 0.03, Expected::kGrasp},
    {"spread in a lumen", tube, Way::kSpread, 0.03, Expected::kNothing},
    {"open sheet", sheet, Way::kClose, 0.03, Expected::kGrasp},
    {"open sheet, oblique", sheet, Way::kCloseOn, 0.8, Expected::kAnything},
    {"bumps", bumps, Way::kClose, 0.03, Expected::kGrasp},
    {"forceps", egg, Way::kForceps, 0.1, Expected::kGrasp},
    {"wide forceps", egg, Way::kWideForceps, 0.1, Expected::kNothing},
    {"closed jaws poke", egg, Way::kPoke, 0.3, Expected::kNothing},
    {"closed jaws poke a slab", slab, Way::kPoke, 0.3, Expected::kNothing}};

/// A jaw around x, whose inner face is at z = 0.
LinkPart make_jaw(const Vector3d& size, int shape) {
  const Isometry3d middle(Translation3d(0.0, 0.0, 0.5 * size.z()));
  if (shape == 0) return LinkPart::sphere(middle.translation(), 0.5 * size.z());
  if (shape == 1) return LinkPart::box(middle, size);
  return LinkPart::cylinder(middle * AngleAxisd(M_PI / 2, Vector3d::UnitY()), 0.5 * size.z(),
                            size.x());
}

/// The poses of both jaws in one closing after another. Between them, the jaws are far away.
std::vector<Poses> closings(const GraspKind& kind, double thickness, double height, double gap,
                            Random& random) {
  const auto tilt = [&] { return Isometry3d(random_turn(random.uniform(0.0, kind.tilt), random)); };
  const Isometry3d first = tilt(),
                   second = Isometry3d(AngleAxisd(M_PI, Vector3d::UnitX())) * tilt();
  Isometry3d tool(tilt() * AngleAxisd(random.uniform(-M_PI, M_PI), Vector3d::UnitZ()));
  const bool from_above = kind.way >= Way::kForceps, in_tube = kind.tissue == tube;
  if (in_tube) tool = tilt();
  if (kind.way == Way::kInLumen) tool.translation() = Vector3d(0.0, 0.0, kLumen + 0.1 * thickness);
  if (!in_tube) {
    tool.pretranslate(Vector3d(random.uniform(-0.002, 0.002), random.uniform(-0.002, 0.002), 0.0));
  }
  if (kind.tissue == fold) tool.translation().x() -= 0.012;
  double tight = (kind.tissue == sheet        ? 0.0
                  : kind.way == Way::kInLumen ? 0.2 * thickness
                                              : thickness) -
                 height * random.uniform(0.2, 0.6);
  double wide = kind.way == Way::kInLumen ? 0.2 * thickness + 0.008 : thickness + 0.01;
  // The middle of a flat facet of the lumen is up to 0.1 mm farther in than its edges.
  if (kind.way == Way::kInLumen) tight -= 2e-4;
  if (kind.way == Way::kCloseOn) tight -= 3.0 * height;
  if (kind.way == Way::kSpread) wide = 0.001, tight = 2.0 * kLumen - 2.0 * height + 0.2 * height;
  if (from_above) {
    tool = tilt() * AngleAxisd(M_PI / 2, Vector3d::UnitY());
    wide = 3.5 * gap + 0.006, tight = 1e-4;
    if (kind.way == Way::kWideForceps) tight = 1.5 * gap + 0.001;
    if (kind.way == Way::kPoke) wide = tight = random.uniform(0.0, 0.001);
  }
  const double depth = kind.way == Way::kPoke ? 0.3 * height : 0.006;
  std::vector<Poses> poses;
  const int held = random.integer(3, 12);
  for (int closing = random.integer(1, 2); closing > 0; --closing) {
    for (int i = -12; i < held + 12; ++i) {
      const double open = std::clamp(std::max(-i, i - held) / 8.0, 0.0, 1.0);
      const double away = std::max(0, std::max(-i, i - held) - 8) / 4.0;
      const double half = 0.5 * (tight + open * (wide - tight));
      Isometry3d at = tool;
      if (kind.tissue == bumps) at.translate(Vector3d(0.0002 * i, 0.0001 * i, 0.0));
      at.pretranslate(from_above ? Vector3d(0.0, 0.0, 0.03 * away - depth)
                                 : Vector3d(0.1 * away, 0.0, 0.0));
      at.translate(random.point(2e-5));
      if (from_above) {  // Their ends touch first.
        const double top = kind.tissue == slab ? 0.5 * thickness : 0.0;
        at.pretranslate(Vector3d(0.0, 0.0, top + 0.008));
      }
      poses.push_back({at * Translation3d(0.0, 0.0, half) * first,
                       at * Translation3d(0.0, 0.0, -half) * second});
    }
  }
  return poses;
}

class GraspProof {
 public:
  GraspProof(const PickerSettings& picker, Random& random) : query_(picker), random_(random) {}

  Tally close(const GraspKind& kind) {
    const double thickness =
        random_.scale(kind.expected == Expected::kAnything ? 0.001 : 0.008, 0.02);
    Tissue tissue = kind.tissue(thickness);
    if (random_.chance(0.3)) {  // Faces that point inward.
      for (std::size_t i = 0; i < tissue.triangles.size(); i += 3)
        std::swap(tissue.triangles[i], tissue.triangles[i + 1]);
    }
    DeformableOrgan organ("tissue", "map", {tissue.vertices, tissue.triangles}, {}, {});
    organ.surface()->find();
    // The sign of a normal that points into a closed organ.
    const double inward = kind.tissue == sheet                 ? 0.0
                          : volume(*organ.latest().mesh) > 0.0 ? -1.0
                                                               : 1.0;
    const Vector3d size(0.016, random_.uniform(0.002, 0.005), random_.uniform(0.001, 0.003));
    Tool tool;
    tool.parameters.name = "jaws";
    tool.parameters.links = {"first", "second"};
    tool.parameters.jaws = {{{"first"}, {"second"}}};
    const bool closes_gap = kind.way == Way::kForceps;
    const double gap = closes_gap || random_.chance(0.7) ? random_.uniform(0.004, 0.008) : 0.0;
    tool.parameters.grasp_gap = gap;
    const LinkPart jaw = make_jaw(
        size, kind.way >= Way::kForceps || kind.tissue == sheet ? 1 : random_.integer(0, 2));
    tool.links = {{"first", {jaw}}, {"second", {jaw}}};
    const bool is_smooth = random_.chance(0.5);
    const std::int64_t hold = is_smooth ? 50'000'000 : random_.integer(0, 3) * 30'000'000LL;
    const double period = random_.scale(0.004, 0.03);
    Tally tally;
    const std::vector<Poses> all = closings(kind, thickness, size.z(), gap, random_);
    tally.count("closings", 1);
    GraspOracle oracle(gap, hold);
    std::vector<Grasp> events;
    TouchTracker tracker([](const TouchEvent&) {},
                         [&](const Grasp& event) { events.push_back(event); });
    std::map<std::uint64_t, double> sides;  // of the touching contacts of an open organ
    boost::shared_ptr<ContactArray> last;
    Poses before;
    std::int64_t now = 1'000'000'000'000;
    bool is_wrong = false;
    long grasps = 0;
    for (const Poses& poses : all) {
      if (!is_smooth && random_.chance(0.03)) {
        is_wrong |= !ends(events, oracle, "reset", [&] { tracker.end_all("reset"); });
        oracle = GraspOracle(gap, hold);
        last.reset();
      }
      ContactArray failure;
      failure.organ = "tissue";
      failure.tool = "jaws";
      failure.status = ContactArray::NO_TRANSFORM;
      if (!is_smooth && random_.chance(0.1)) tracker.follow_failure(failure, {});
      if (!is_smooth && random_.chance(0.03)) last.reset();  // New triangles.
      const bool jumps = !is_smooth && random_.chance(0.1);
      now += jumps ? random_.integer(0, 1) * 100'000'000LL : std::llround(1e9 * period);
      organ_collision::ToolStep step{0, nullptr};
      step.question.tool = {std::shared_ptr<const Tool>(), &tool};
      step.question.organ = "tissue";
      step.question.tool_name = "jaws";
      step.question.shape = organ.latest();
      step.question.start = step.question.end =
          ros::Time().fromNSec(static_cast<std::uint64_t>(now));
      step.last_answer = last;
      const ShaftAxis none{Vector3d::Zero(), Vector3d::Zero()};
      ToolPath path = {{0.0, none, poses}};
      if (last) {
        path = {{0.0, none, before}, {1.0, none, poses}};
        step.question.asked.mode = QueryMode::kSwept;
        step.question.start = last->header.stamp;
      }
      const CollisionRequest request = step.question.request(path);
      step.answer = boost::make_shared<ContactArray>(step.question.unanswered());
      query_.evaluate(request, *step.answer);
      set_memory(*step.answer, last.get());
      step.question.sampled.path = path;
      tracker.follow(step, {}, 1e-9 * static_cast<double>(hold));
      const std::string expected = oracle.add(answered(step, poses, tool, inward, sides));
      is_wrong |= !agrees(events, oracle, expected);
      grasps += expected == "grasped";
      last = step.answer;
      before = poses;
      tally.count("steps", 1);
    }
    const long count = all.size() > 40 ? 2 : 1;
    const bool is_expected = !is_smooth || kind.expected == Expected::kAnything ||
                             grasps == (kind.expected == Expected::kGrasp ? count : 0);
    tally.count("grasps", grasps);
    tally.count("wrong", is_wrong);
    tally.count("not as expected", !is_expected);
    return tally;
  }

 private:
  /// Six times the volume that the faces enclose; negative if they point inward.
  static double volume(const TriangleMesh& mesh) {
    double sum = 0.0;
    for (std::size_t face = 0; face < mesh.face_count(); ++face) {
      const Triangle corners = mesh.triangle(face);
      sum += corners[0].dot(corners[1].cross(corners[2]));
    }
    return sum;
  }

  /// What an answer tells, with the normals of the definition.
  static Answered answered(const organ_collision::ToolStep& step, const Poses& poses,
                           const Tool& tool, double inward,
                           std::map<std::uint64_t, double>& sides) {
    const TriangleMesh& mesh = *step.question.shape.mesh;
    Answered answer{};
    answer.stamp = static_cast<std::int64_t>(step.answer->header.stamp.toNSec());
    answer.same_triangles = step.last_answer != nullptr;
    answer.poses = poses;
    const Vector3d center = tool.links[0].parts[0].bounds.center;
    answer.width = (poses[1] * center - poses[0] * center).norm();
    std::map<std::uint64_t, double> now;
    for (const Contact& contact : step.answer->contacts) {
      if (!contact.touching) continue;
      const Triangle corners = mesh.triangle(contact.face);
      const Vector3d n = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
      const std::uint64_t key = 2 * contact.face + static_cast<std::uint64_t>(contact.link);
      const Vector3d normal(contact.normal.x, contact.normal.y, contact.normal.z);
      const auto known = sides.find(key);
      const bool lasts = answer.same_triangles && known != sides.end() && contact.fraction == 0.0;
      now[key] = lasts ? known->second : normal.dot(n) > 0.0 ? 1.0 : -1.0;
      const double sign = inward != 0.0 ? inward : now[key];
      const auto jaw = static_cast<std::size_t>(contact.link);
      const auto& at = contact.on_organ;
      answer.touches[jaw].push_back({contact.face, {at.x, at.y, at.z}, sign * n});
    }
    sides = now;
    return answer;
  }

  /// Whether the messages since the last call are those of the oracle.
  static bool agrees(std::vector<Grasp>& events, const GraspOracle& oracle,
                     const std::string& expected) {
    const std::vector<Grasp> told = std::exchange(events, {});
    if (expected.empty()) return told.empty();
    if (told.size() != 1) return false;
    const Grasp& event = told.front();
    const Answered& of = oracle.last_opposed();
    const Answered::Nearest& pair = expected == "grasped" ? *of.begins : *of.holds;
    const bool is_end = expected != "grasped";
    const auto faces = [](const std::vector<Answered::Touch>& touches) {
      std::vector<std::uint32_t> list;
      for (const auto& touch : touches) list.push_back(touch.face);
      return list;
    };
    return event.event == (is_end ? Grasp::RELEASED : Grasp::GRASPED) &&
           event.reason == (is_end ? expected : "") && event.thickness == pair.distance &&
           event.header.stamp.toNSec() == static_cast<std::uint64_t>(of.stamp) &&
           event.on_first.x == pair.first.at.x() && event.on_second.z == pair.second.at.z() &&
           event.faces_first == faces(of.touches[0]) &&
           event.faces_second == faces(of.touches[1]) &&
           (!is_end ||
            std::abs(event.duration_sec - 1e-9 * static_cast<double>(oracle.duration())) < 1e-9);
  }

  /// Whether an end with a reason ends the grasp, if there is one.
  static bool ends(std::vector<Grasp>& events, const GraspOracle& oracle, const std::string& reason,
                   const std::function<void()>& end) {
    end();
    return agrees(events, oracle, oracle.is_grasped() ? reason : "");
  }

  ContactQuery query_;
  Random& random_;
};

bool is_right(const Tally& tally) {
  return tally.get("wrong") == 0.0 && tally.get("not as expected") == 0.0;
}

}  // namespace

bool prove_grasps(const ProofSize& size, Progress& progress) {
  const std::vector<std::string> names = names_of(kKinds);
  const long each = size.pairs / 10 / static_cast<long>(names.size()) + 1;
  std::vector<Tally> tallies(names.size());
  for (std::size_t kind = 0; kind < names.size(); ++kind) {
    Random random(1000 * size.seed + kind);
    PickerSettings picker;
    picker.kind = size.pickers.front();
    GraspProof proof(picker, random);
    for (long i = 0; i < each; ++i) {
      progress.show("grasps, " + names[kind], i, each);
      const Tally tally = proof.close(kKinds[kind]);
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
