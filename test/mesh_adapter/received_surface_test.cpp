#include "mesh_adapter/received_surface.hpp"

#include <gtest/gtest.h>

TEST(ReceivedSurface, IsEmptyWithoutVerticesAndTriangles) {
  organ_collision::ReceivedSurface surface;
  surface.frame = "liver";
  EXPECT_TRUE(surface.empty());
  surface.triangles = {0, 1, 2};
  EXPECT_FALSE(surface.empty());
  surface.triangles.clear();
  surface.vertices = {0.1f, 0.2f, 0.3f};
  EXPECT_FALSE(surface.empty());
}
