#include "grasper.hpp"

#include <algorithm>
#include <cmath>

namespace organ_collision::bench {
namespace {

using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;
constexpr double kWristLength = 0.008;         // [m]
constexpr int kSides = 10, kRings = 25;        // of a jaw: 2 · 10 · 25 faces
const Vector3d kJawHalf(0.002, 0.0015, 0.01);  // [m]

// An ellipsoid that begins at the joint and extends along z.
LinkPart jaw() {
  std::vector<Vector3d> vertices;
  std::vector<FaceIndices> faces;
  vertices.emplace_back(0.0, 0.0, 0.0);
  for (int ring = 1; ring <= kRings; ++ring) {
    const double along = kPi * ring / (kRings + 1);
    for (int side = 0; side < kSides; ++side) {
      const double around = 2.0 * kPi * side / kSides;
      const Vector3d sphere(std::sin(along) * std::cos(around), std::sin(along) * std::sin(around),
                            1.0 - std::cos(along));
      vertices.push_back(sphere.cwiseProduct(kJawHalf));
    }
  }
  vertices.emplace_back(0.0, 0.0, 2.0 * kJawHalf.z());
  const auto at = [](int ring, int side) -> std::uint32_t {
    if (ring == 0) return 0;
    if (ring > kRings) return 1 + kRings * kSides;
    return static_cast<std::uint32_t>(1 + (ring - 1) * kSides + side % kSides);
  };
  for (int ring = 0; ring <= kRings; ++ring) {
    for (int side = 0; side < kSides; ++side) {
      if (ring < kRings)
        faces.push_back({at(ring, side), at(ring + 1, side + 1), at(ring + 1, side)});
      if (ring > 0) faces.push_back({at(ring, side), at(ring, side + 1), at(ring + 1, side + 1)});
    }
  }
  return LinkPart::mesh({std::move(vertices), std::move(faces)});
}

}  // namespace

std::vector<Link> Grasper::make_links() {
  Eigen::Isometry3d middle = Eigen::Isometry3d::Identity();
  middle.translation().z() = 0.5 * kWristLength;
  return {{"wrist", {LinkPart::cylinder(middle, kRadius, kWristLength)}},
          {"left_jaw", {jaw()}},
          {"right_jaw", {jaw()}}};
}

ToolWaypoint Grasper::place(double fraction, const ShaftAxis& axis, double opening) {
  Eigen::Isometry3d wrist = Eigen::Isometry3d::Identity();
  wrist.linear() = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), axis.tip - axis.trocar)
                       .toRotationMatrix();
  wrist.translation() = axis.tip;
  const Eigen::Isometry3d joint = wrist * Eigen::Translation3d(0.0, 0.0, kWristLength);
  return {fraction,
          axis,
          {wrist, joint * Eigen::AngleAxisd(opening, Vector3d::UnitX()),
           joint * Eigen::AngleAxisd(-opening, Vector3d::UnitX())}};
}

}  // namespace organ_collision::bench
