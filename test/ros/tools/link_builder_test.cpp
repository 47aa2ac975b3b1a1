#include "ros/tools/link_builder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ros/tools/link_description.hpp"
#include "tool_files.hpp"

using namespace organ_collision;
using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const ShapePose kPose{{0.1, 0.2, 0.3}, {std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)}};
const std::vector<Vector3d> kCorners = {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)};

std::string refusal(const ShapeDescription& shape) {
  return tool_error([&] { build_link("tip", {"wrist", {shape}}); });
}

}  // namespace

TEST(LinkBuilder, ShapesInTheirOrderAndWhereTheyAre) {
  const Link link =
      build_link("tip", {"wrist",
                         {SphereDescription{kPose, 0.5}, CylinderDescription{kPose, 0.1, 2.0},
                          BoxDescription{kPose, {1.0, 2.0, 3.0}},
                          MeshDescription{"tip.stl", kCorners, {{0, 1, 2}}}}});
  EXPECT_EQ(link.name, "tip");
  ASSERT_EQ(link.parts.size(), 4u);
  EXPECT_EQ(link.parts[0].radius, 0.5);
  EXPECT_NEAR(link.parts[0].project_onto(Vector3d::UnitX()).high, 0.1, 1e-15);
  EXPECT_NEAR(link.parts[1].project_onto(Vector3d::UnitZ()).high, 1.3, 1e-15);
  EXPECT_NEAR(link.parts[2].project_onto(Vector3d::UnitX()).high, 1.1,
              1e-15);  // Half of the side along y.
  EXPECT_EQ(link.parts[3].project_onto(Vector3d::UnitX()).high, 1.0);
}

TEST(LinkBuilder, IllegalSizesAreNamed) {
  expect_words(refusal(SphereDescription{kPose, 0.0}),
               {"link 'tip'", "sphere's radius is 0", "more than 0"});
  expect_words(refusal(SphereDescription{kPose, 2e6}), {"2e+06", "at most 1e+06 m"});
  expect_words(refusal(SphereDescription{kPose, std::nan("")}), {"sphere's radius is nan"});
  expect_words(refusal(CylinderDescription{kPose, -0.01, 1.0}),
               {"link 'tip'", "cylinder's radius is -0.01", "more than 0"});
  expect_words(refusal(CylinderDescription{kPose, 0.01, 0.0}), {"cylinder's length is 0"});
  expect_words(refusal(BoxDescription{kPose, {1.0, -2.0, 3.0}}),
               {"link 'tip'", "box's side is -2", "more than 0"});
}

TEST(LinkBuilder, IllegalPosesAreNamed) {
  for (const double bad : {-1e7, kInfinity, std::nan("")}) {
    expect_words(refusal(SphereDescription{{{0.0, bad, 0.0}, kPose.orientation}, 1.0}),
                 {"link 'tip'", "origin", "finite and within 1e+06 m"});
  }
  for (const double bad : {2.0, 0.0, kInfinity, std::nan("")}) {
    const ShapePose pose{kPose.position, Quaterniond(bad, 0.0, 0.0, 0.0)};
    expect_words(refusal(BoxDescription{pose, Vector3d::Ones()}),
                 {"link 'tip'", "orientation", "unit quaternion"});
    expect_words(refusal(SphereDescription{pose, 1.0}), {"orientation"});
    expect_words(refusal(CylinderDescription{pose, 1.0, 1.0}), {"orientation"});
  }
}

TEST(LinkBuilder, IllegalMeshesAreNamed) {
  expect_words(refusal(MeshDescription{"tip.stl", kCorners, {}}),
               {"link 'tip'", "mesh 'tip.stl'", "no triangle"});
  expect_words(refusal(MeshDescription{"tip.stl", kCorners, {{0, 1, 3}}}), {"vertex 3 of 3"});
  expect_words(refusal(MeshDescription{"tip.stl", {Vector3d(2e6, 0, 0)}, {{0, 0, 0}}}),
               {"mesh 'tip.stl'", "vertex 0", "within 1e+06 m"});
}

TEST(LinkBuilder, LinksWithoutShapeAreRefused) {
  expect_words(tool_error([] { build_link("mount", {}); }),
               {"link 'mount'", "no collision or visual geometry"});
}
