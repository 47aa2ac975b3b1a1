#include "scripted_hand.hpp"

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

}  // namespace organ_collision::oracle
