#include "query/proxy/organ_pieces.hpp"

#include <gtest/gtest.h>

#include "proxy_scenes.hpp"

namespace organ_collision {
namespace {

TEST(OrganPieces, EachPieceBeginsWhereTheLastOneEnded) {
  const Shape before = shape_of(grid_surface(5, 0.0)), now = shape_of(grid_surface(5, 1.0));
  OrganTick organ = moving(before, now);
  organ.T_now = translation(0.01, 0.02, 0.03);
  constexpr int kPieces = 4;
  const OrganPieces pieces({organ}, kPieces);
  const TriangleMesh* shape = before.get();
  Eigen::Isometry3d frame = organ.T_before;
  for (int i = 0; i < kPieces; ++i) {
    const std::vector<OrganTick> piece = pieces.piece(i);
    ASSERT_EQ(piece.size(), 1u);
    EXPECT_EQ(piece[0].before, shape);
    EXPECT_TRUE(piece[0].T_before.isApprox(frame));
    EXPECT_TRUE(piece[0].is_moving());
    const double end = (i + 1.0) / kPieces;
    for (std::size_t k = 0; k < now->vertices().size(); ++k) {
      const float from = before->vertices()[k], to = now->vertices()[k];
      EXPECT_NEAR(piece[0].now->vertices()[k], from + end * (to - from), 1e-8);
    }
    EXPECT_NEAR(piece[0].T_now.translation().z(), 0.03 * end, 1e-12);
    shape = piece[0].now;
    frame = piece[0].T_now;
  }
  EXPECT_EQ(shape, now.get());
  EXPECT_TRUE(frame.isApprox(organ.T_now));
}

TEST(OrganPieces, ARestingOrganKeepsItsShape) {
  const Shape shape = sheet(0.0);
  const OrganPieces pieces({resting(shape)}, 3);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(pieces.piece(i)[0].now, shape.get());
    EXPECT_FALSE(pieces.piece(i)[0].is_moving());
  }
}

TEST(OrganPieces, ANewOrganHasNoShapeToMoveFrom) {
  const Shape shape = sheet(0.0);
  OrganTick organ = resting(shape);
  organ.before = nullptr;
  const OrganPieces pieces({organ}, 2);
  EXPECT_EQ(pieces.piece(0)[0].now, shape.get());
  EXPECT_FALSE(pieces.piece(0)[0].is_moving());
}

}  // namespace
}  // namespace organ_collision
