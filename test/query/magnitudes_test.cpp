// collision_query.hpp for all legal magnitudes of radius, shaft length, motion and organ.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "organ_collision/geometry/tolerances.hpp"
#include "scenes.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

constexpr double kTiniest = 1e-300;  // [m]
constexpr QueryMode kModes[] = {QueryMode::kStatic, QueryMode::kSwept, QueryMode::kPaperStatic,
                                QueryMode::kPaperSwept, QueryMode::kPaperNaive};

/// [m] A size of any magnitude: ordinary sizes, and sizes near the limits of 32-bit and 64-bit
/// numbers.
double some_size(Random& random) {
  const double size[] = {random.scale(1e-3, 0.3), random.scale(1e-12, 1e6),
                         random.scale(1e-50, 1e-12), random.scale(kTiniest, 1e-50), 1e-20};
  return size[random.integer(0, 4)];
}

Vector3d within_reach(const Vector3d& point) {
  return point.cwiseMax(-tolerance::kFarthest).cwiseMin(tolerance::kFarthest);
}

/// Faces of about the given size around the axis at the start or end of a path.
TriangleMesh faces_about(const ToolPath& path, double size, Random& random) {
  std::vector<float> vertices;
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t i = 0; i < 30; ++i) {
    const ShaftAxis& axis = path[random.integer(0, 1)].axis;
    const Vector3d amid = axis.at(random.uniform(0.0, 1.0));
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      const Vector3d vertex = within_reach(amid + size * random.direction());
      for (int k = 0; k < 3; ++k) vertices.push_back(static_cast<float>(vertex[k]));
      triangles.push_back(3 * i + corner);
    }
  }
  return {vertices, triangles};
}

void expect_finite(const FaceContact& contact) {
  EXPECT_TRUE(std::isfinite(contact.fraction));
  EXPECT_TRUE(contact.point.allFinite());
  EXPECT_TRUE(contact.normal.allFinite());
  EXPECT_TRUE(contact.barycentric.allFinite());
  EXPECT_TRUE(std::isfinite(contact.shaft));
  EXPECT_TRUE(std::isfinite(contact.depth));
  EXPECT_TRUE(contact.end_point.allFinite());
  EXPECT_TRUE(std::isfinite(contact.view_min));
  EXPECT_TRUE(std::isfinite(contact.view_max));
}

/// The depths along the view lie between 0 and the length of the shaft.
void expect_within_view(const FaceContact& contact, const ToolPath& path) {
  double length = 0.0;
  for (const auto& [fraction, axis, links] : path) {
    length = std::max(length, (axis.tip - axis.trocar).norm());
  }
  EXPECT_GE(contact.view_min, 0.0);
  EXPECT_LE(contact.view_min, contact.view_max);
  EXPECT_LE(contact.view_max, length * (1.0 + 1e-6));
}

using MagnitudesWith = CollisionQueryWith;

TEST_P(MagnitudesWith, AnswersAreFiniteOrRefused) {
  Random random(1);
  std::size_t answered = 0, refused = 0, found = 0;
  for (int i = 0; i < 3000 && !HasFailure(); ++i) {
    const Vector3d trocar = random.chance(0.7) ? Vector3d(random.point(0.3))
                                               : Vector3d(random.point(tolerance::kFarthest));
    const double length = some_size(random), step = some_size(random);
    const Vector3d tip = within_reach(trocar + length * random.direction());
    const ToolPath path = {{0.0, {trocar, tip}},
                           {1.0, {trocar, within_reach(tip + step * random.direction())}}};
    const TriangleMesh organ = faces_about(path, some_size(random), random);
    CollisionRequest request = swept(organ, path, some_size(random));
    request.mode = kModes[i % std::size(kModes)];
    request.regions = random.chance(0.3) && i % 5 < 2;
    try {
      query_.evaluate(request, result_);
      ++answered;
      found += result_.contacts.size();
    } catch (const std::invalid_argument& error) {
      ++refused;
      EXPECT_GE(i % 5, 2) << "only the paper's volumes have limits: " << error.what();
    }
    for (const FaceContact& contact : result_.contacts) {
      expect_finite(contact);
      if (i % 5 >= 2) expect_within_view(contact, path);
    }
    for (const Region& region : result_.regions) {
      for (const Vector3d& corner : region) EXPECT_TRUE(corner.allFinite());
    }
    if (HasFailure()) {
      ADD_FAILURE() << "mode " << i % 5 << ", radius " << request.radius << ", length " << length
                    << ", step " << step << ", trocar " << trocar.transpose() << ", tip "
                    << tip.transpose();
    }
  }
  EXPECT_GT(answered, 1500U);
  EXPECT_GT(refused, 300U);
  EXPECT_GT(found, 5000U);
}

TEST_P(MagnitudesWith, PaperVolumesTooThinForClippingAreRefusedByName) {
  Random random(2);
  const TriangleMesh organ = mesh(liver());
  const Vector3d trocar(0.02, -0.03, 0.25);
  CollisionRequest request = swept(
      organ, {{0.0, {trocar, {0.01, 0.01, 0.035}}}, {1.0, {trocar, {-0.03, 0.01, 0.03}}}}, 1e-20);
  for (const QueryMode mode :
       {QueryMode::kPaperStatic, QueryMode::kPaperSwept, QueryMode::kPaperNaive}) {
    request.mode = mode;
    request.radius = 1e-20;
    try {
      query_.evaluate(request, result_);
      ADD_FAILURE() << "accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("1e-20"), std::string::npos) << error.what();
    }
    EXPECT_TRUE(result_.contacts.empty());
    request.radius = 1e-5;
    EXPECT_NO_THROW(query_.evaluate(request, result_));
  }
}

INSTANTIATE_TEST_SUITE_P(Pickers, MagnitudesWith,
                         testing::Values(PickerKind::kFeedback, PickerKind::kSelect,
                                         PickerKind::kCpu));

}  // namespace
}  // namespace organ_collision
