#include "guarded_scene.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "test/closed_surfaces.hpp"

namespace organ_collision::bench {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;
constexpr double kTick = 1e-3;  // [s]

const Vector3d kSemiAxes(0.1, 0.07, 0.04);        // [m]
constexpr double kAmplitude = 4e-3;               // [m] of the waves
constexpr double kFrequency = 1.2;                // [Hz]
const Vector3d kWaveNumber(70.0, 50.0, 40.0);     // [rad/m]
const Vector3d kTrocar(0.03, 0.02, 0.18);         // [m]
const Vector3d kReach(0.07, 0.05, 0.05);          // [m] half of the Lissajous curve
const Vector3d kHandFrequencies(0.5, 0.8, 1.1);   // [Hz]
const Vector3d kHandPhases(0.0, 0.5 * kPi, 1.0);  // [rad]
constexpr double kShaftRadius = 2e-3;             // [m]
constexpr std::size_t kArmLinks = 9;
constexpr double kLinkLength = 0.03;  // [m]
constexpr double kLinkAngle = 0.12;   // [rad] the most between two links

Eigen::Map<const Eigen::VectorXf> as_vector(const std::vector<float>& vertices) {
  return {vertices.data(), static_cast<Eigen::Index>(vertices.size())};
}

}  // namespace

WavingEllipsoid::WavingEllipsoid(std::size_t faces) {
  static const std::map<std::size_t, std::pair<int, int>> grids = {
      {10'000, {50, 100}}, {100'000, {200, 250}}, {200'000, {250, 400}}, {1'000'000, {500, 1000}}};
  const auto grid = grids.find(faces);
  if (grid == grids.end()) {
    throw std::invalid_argument("there is no ellipsoid of " + std::to_string(faces) + " faces");
  }
  surface_ = sphere(grid->second.first, grid->second.second, 1.0);
  sine_.resize(static_cast<Eigen::Index>(surface_.vertices.size()));
  cosine_.resize(sine_.size());
  for (Eigen::Index i = 0; i < sine_.size(); i += 3) {
    Eigen::Map<Eigen::Vector3f> vertex(&surface_.vertices[static_cast<std::size_t>(i)]);
    const Vector3d unit = vertex.cast<double>(), at = unit.cwiseProduct(kSemiAxes);
    const Vector3d normal = unit.cwiseQuotient(kSemiAxes).normalized();
    const double phase = kWaveNumber.dot(at);
    vertex = at.cast<float>();
    sine_.segment<3>(i) = (kAmplitude * std::sin(phase) * normal).cast<float>();
    cosine_.segment<3>(i) = (kAmplitude * std::cos(phase) * normal).cast<float>();
  }
}

SharedVertices WavingEllipsoid::shape(std::size_t tick) const {
  const double phase = 2.0 * kPi * kFrequency * kTick * static_cast<double>(tick);
  auto vertices = std::make_shared<std::vector<float>>(surface_.vertices.size());
  Eigen::Map<Eigen::VectorXf>(vertices->data(), sine_.size()) =
      as_vector(surface_.vertices) + static_cast<float>(std::cos(phase)) * sine_ -
      static_cast<float>(std::sin(phase)) * cosine_;
  return vertices;
}

ProxyTool make_guarded_tool(GuardedTool tool) {
  if (tool == GuardedTool::kShaft) return {kShaftRadius, {}, ProxyFreedom::kTrocar};
  ProxyTool arm{0.0, {}, ProxyFreedom::kFree};
  for (std::size_t i = 0; i < kArmLinks; ++i) {
    const Isometry3d middle(Eigen::Translation3d(0.0, 0.0, 0.5 * kLinkLength));
    arm.links.push_back({"link" + std::to_string(i),
                         {LinkPart::cylinder(middle, kGuardedLinkRadius, kLinkLength)}});
  }
  return arm;
}

ToolPose guarded_hand(GuardedTool tool, std::size_t tick) {
  const double time = kTick * static_cast<double>(tick);
  const Vector3d tip = kReach.cwiseProduct(
      ((2.0 * kPi * time * kHandFrequencies + kHandPhases).array().sin()).matrix());
  if (tool == GuardedTool::kShaft) return {{kTrocar, tip}};
  // From the tip upward. The joints bend slowly to and fro.
  ToolPose pose{{tip, tip}};
  Isometry3d link(Eigen::Translation3d(tip) *
                  Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), kTrocar - tip));
  for (std::size_t i = 0; i < kArmLinks; ++i) {
    pose.links.push_back(link);
    const double angle = kLinkAngle * std::sin(2.0 * kPi * 0.3 * time + static_cast<double>(i));
    link = link * Eigen::Translation3d(0.0, 0.0, kLinkLength) *
           Eigen::AngleAxisd(angle, i % 2 == 0 ? Vector3d::UnitX() : Vector3d::UnitY());
  }
  return pose;
}

std::vector<ShaftAxis> guarded_axes(GuardedTool tool, const ToolPose& pose) {
  if (tool == GuardedTool::kShaft) return {pose.axis};
  std::vector<ShaftAxis> axes;
  for (const Isometry3d& link : pose.links) {
    axes.push_back({link.translation(), link * Vector3d(0.0, 0.0, kLinkLength)});
  }
  return axes;
}

}  // namespace organ_collision::bench
