#include "ros/organs/organ_surface.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "test/ros/organs/solids.hpp"

using namespace organ_collision;

TEST(OrganSurface, IsKnownOnceItIsFound) {
  OrganSurface surface(tetrahedron());
  EXPECT_FALSE(surface.is_found());
  surface.find();
  ASSERT_TRUE(surface.is_found());
  EXPECT_TRUE(surface.topology().is_closed());
  EXPECT_FALSE(surface.is_inward());
  surface.find();
  EXPECT_TRUE(surface.is_found());
}

TEST(OrganSurface, VolumeIsOfTheGivenShape) {
  const TriangleMesh mesh = tetrahedron();
  OrganSurface surface(mesh);
  surface.find();
  const double volume = surface.volume(mesh.vertices());
  EXPECT_NEAR(volume, 0.03 * 0.04 * 0.05 / 6.0, 1e-10);
  std::vector<float> twice = mesh.vertices();
  for (float& coordinate : twice) coordinate *= 2.0F;
  EXPECT_NEAR(surface.volume(twice), 8.0 * volume, 1e-11);
}

TEST(OrganSurface, InwardIsAVolumeBelowZero) {
  OrganSurface inward(tetrahedron(kInward));
  inward.find();
  EXPECT_TRUE(inward.topology().is_closed());
  EXPECT_TRUE(inward.is_inward());
  // Both sides of a sheet enclose nothing; what rounding leaves is no orientation.
  OrganSurface sheet(
      TriangleMesh({0.1F, 0.7F, 0.3F, 1.1F, 0.2F, 0.9F, 0.4F, 1.3F, 0.6F}, {0, 1, 2, 2, 1, 0}));
  sheet.find();
  EXPECT_TRUE(sheet.topology().is_closed());
  EXPECT_FALSE(sheet.is_inward());
  OrganSurface open(tetrahedron({0, 1, 2}));
  open.find();
  EXPECT_FALSE(open.is_inward());
}

TEST(OrganSurface, AnotherThreadMayWaitForIt) {
  const std::chrono::milliseconds none(0);
  const std::chrono::seconds long_enough(60);
  OrganSurface surface(tetrahedron());
  EXPECT_FALSE(surface.wait_until_found(none));
  bool found = false;
  std::thread waiting([&] { found = surface.wait_until_found(long_enough); });
  surface.find();
  waiting.join();
  EXPECT_TRUE(found);
  EXPECT_TRUE(surface.wait_until_found(none));
}
