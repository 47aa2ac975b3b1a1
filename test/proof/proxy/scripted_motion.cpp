#include "scripted_motion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;

constexpr double kTick = 1e-3;       // [s]
constexpr double kLeastJump = 0.06;  // [m]
constexpr double kSplinePeak = 1.5;  // the highest speed of a cubic, as a share of the mean one

Vector3d random_place(const Eigen::AlignedBox3d& box, Random& random) {
  return box.min() +
         Vector3d(random.uniform(0.0, 1.0), random.uniform(0.0, 1.0), random.uniform(0.0, 1.0))
             .cwiseProduct(box.sizes());
}

}  // namespace

ScriptedHand::ScriptedHand(HandScript script, Random& random)
    : script_(std::move(script)),
      random_(static_cast<std::uint64_t>(random.integer(0, 1 << 30))),
      from_(script_.start),
      to_(script_.start),
      u_(Vector3d::Zero()),
      v_(Vector3d::Zero()),
      turn_phases_(random_.point(M_PI)) {
  pose_.links.resize(script_.tool.links.size());
}

void ScriptedHand::start_act() {
  from_ = to_;
  act_begin_ = tick_ - 1;
  const double speed = script_.speed * random_.scale(0.1, 1.0);
  act_ = static_cast<Act>(random_.integer(0, script_.jumps ? 5 : 4));
  long ticks = random_.integer(50, 600);
  if (act_ == Act::kSpline || act_ == Act::kStab) {
    to_ = random_place(script_.reach, random_);
    const double peak = act_ == Act::kSpline ? kSplinePeak : 1.0;
    ticks = std::lround(std::ceil(peak * (to_ - from_).norm() / (speed * kTick)));
  } else if (act_ == Act::kCircle) {
    const double radius = random_.scale(1e-3, 0.02);
    u_ = radius * random_.direction();
    v_ = radius * u_.unitOrthogonal();
    ticks = std::lround(std::ceil(2 * M_PI * radius / (speed * kTick)));
  } else if (act_ == Act::kJitter) {
    jitter_ = random_.scale(1e-7, 0.3 * script_.speed * kTick);
  } else if (act_ == Act::kJump) {
    ticks = 1;
    while ((to_ - from_).norm() < kLeastJump) to_ = random_place(script_.reach, random_);
  }
  act_end_ = act_begin_ + std::max(1L, ticks);
}

/// Where the tip is, without the motion of a trocar.
Vector3d ScriptedHand::place() const {
  const double time =
      static_cast<double>(tick_ - act_begin_) / static_cast<double>(act_end_ - act_begin_);
  switch (act_) {
    case Act::kSpline:
      return from_ + time * time * (3.0 - 2.0 * time) * (to_ - from_);
    case Act::kStab:
    case Act::kJump:
      return from_ + time * (to_ - from_);
    case Act::kCircle:
      return from_ + (std::cos(2 * M_PI * time) - 1.0) * u_ + std::sin(2 * M_PI * time) * v_;
    default:
      return from_;
  }
}

Eigen::Matrix3d ScriptedHand::orientation(const Vector3d& tip) const {
  if (script_.tool.freedom == ProxyFreedom::kTrocar) {
    return Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), pose_.axis.trocar - tip)
        .toRotationMatrix();
  }
  const double angle = script_.turn_rate * kTick * static_cast<double>(tick_);
  const Vector3d turns = (turn_phases_ + angle * Vector3d(1.0, 0.7, 0.45)).array().sin();
  return (Eigen::AngleAxisd(turns[0], Vector3d::UnitX()) *
          Eigen::AngleAxisd(turns[1], Vector3d::UnitY()) *
          Eigen::AngleAxisd(turns[2], Vector3d::UnitZ()))
      .toRotationMatrix();
}

const ToolPose& ScriptedHand::next() {
  ++tick_;
  if (tick_ > act_end_) start_act();
  jumped_ = act_ == Act::kJump;
  const double seconds = kTick * static_cast<double>(tick_);
  Vector3d tip = place();
  if (act_ == Act::kJitter) tip += random_.uniform(0.0, jitter_) * random_.direction();

  pose_.axis.trocar =
      script_.trocar + std::sin(script_.trocar_rate * seconds) * script_.trocar_sway;
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  frame.linear() = orientation(tip);
  frame.translation() = tip;
  pose_.axis.tip = tip;
  if (script_.tool.freedom == ProxyFreedom::kFree) {
    pose_.axis.trocar = frame * Vector3d(0.0, 0.0, script_.shaft_length);
  }
  const double angle = 0.5 * script_.jaw_angle * (1.0 + std::sin(script_.jaw_rate * seconds));
  for (std::size_t i = 0; i < pose_.links.size(); ++i) {
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    pose_.links[i] = frame * Eigen::AngleAxisd(side * angle, Vector3d::UnitX());
  }
  return pose_;
}

OrganMotion random_motion(double speed, double reach, Random& random) {
  OrganMotion motion;
  const double shares[] = {random.uniform(0.1, 1.0), random.uniform(0.1, 1.0),
                           random.uniform(0.1, 1.0)};
  const double share = speed / (shares[0] + shares[1] + shares[2]);
  const double sway = random.scale(1e-3, 0.02), turn = random.scale(0.01, 0.15);
  const double wave = random.scale(2e-4, 5e-3);
  motion.sway = sway * random.direction();
  motion.sway_rate = shares[0] * share / sway;
  motion.turn = turn * random.direction();
  motion.turn_rate = shares[1] * share / (turn * reach);
  motion.wave = wave * random.direction();
  motion.wave_rate = shares[2] * share / wave;
  motion.wave_number = random.uniform(20.0, 60.0) * random.direction();
  motion.ticks_per_shape = static_cast<int>(random.scale(1.0, 100.0));
  motion.moves_frame = random.chance(0.3);
  return motion;
}

ScriptedOrgan::ScriptedOrgan(std::string name, const GridSurface& rest, const OrganMotion& motion)
    : rest_(rest),
      motion_(motion),
      topology_(std::make_shared<SurfaceTopology>(rest.faces, rest.vertices)) {
  organ_.topology = topology_.get();
  organ_.name = std::move(name);
  organ_.shape = std::make_shared<TriangleMesh>(rest.vertices, rest.triangles());
  move_vertices(0.0);
}

ProxyOrgan ScriptedOrgan::at(long tick) {
  const long shape = tick / motion_.ticks_per_shape;
  if (shape != shape_ && motion_.changes_shape()) {
    shape_ = shape;
    move_vertices(kTick * static_cast<double>(shape * motion_.ticks_per_shape));
  }
  if (motion_.moves_frame) {
    organ_.T_organ_proxy = rigid(kTick * static_cast<double>(tick)).inverse();
  }
  return organ_;
}

Eigen::Isometry3d ScriptedOrgan::rigid(double seconds) const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const double angle = motion_.turn.norm();
  if (angle > 0.0) {
    pose.rotate(
        Eigen::AngleAxisd(angle * std::sin(motion_.turn_rate * seconds), motion_.turn / angle));
  }
  pose.translation() = std::sin(motion_.sway_rate * seconds) * motion_.sway;
  return pose;
}

void ScriptedOrgan::move_vertices(double seconds) {
  const Eigen::Isometry3d pose =
      motion_.moves_frame ? Eigen::Isometry3d::Identity() : rigid(seconds);
  const bool waves = !motion_.wave.isZero();
  std::vector<float> vertices = rest_.vertices;
  for (std::size_t i = 0; i < vertices.size(); i += 3) {
    Eigen::Map<Eigen::Vector3f> vertex(&vertices[i]);
    Vector3d at = vertex.cast<double>();
    if (waves) {
      at += std::sin(motion_.wave_number.dot(at) + motion_.wave_rate * seconds) * motion_.wave;
    }
    vertex = (pose * at).cast<float>();
  }
  const auto shape = std::make_shared<TriangleMesh>(*organ_.shape);
  shape->move_vertices(std::move(vertices));
  organ_.shape = shape;
}

}  // namespace organ_collision::oracle
