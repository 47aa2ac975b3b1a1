#include "mesh_adapter/surface.hpp"

#include <gtest/gtest.h>

TEST(Surface, IsEmptyWithoutVerticesAndTriangles) {
  organ_collision::Surface surface;
  surface.frame = "liver";
  EXPECT_TRUE(surface.empty());
  surface.triangles = {0, 1, 2};
  EXPECT_FALSE(surface.empty());
  surface.triangles.clear();
  surface.vertices = {0.1f, 0.2f, 0.3f};
  EXPECT_FALSE(surface.empty());
}
