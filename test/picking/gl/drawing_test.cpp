#include "picking/gl/drawing.hpp"

#include <GL/gl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

using namespace organ_collision;

namespace {

constexpr float kPolygon = GL_POLYGON_TOKEN;

/// A vertex with this number as its face.
void add_vertex(float lower, float upper, std::vector<float>& buffer) {
  buffer.insert(buffer.end(), {1, 2, 0.25f, 1, 1, 1, 1, lower, upper, 0, 1});
}

std::vector<float> triangle(float vertices) {
  std::vector<float> buffer = {kPolygon, vertices};
  for (int i = 0; i < 3; ++i) add_vertex(3, 2, buffer);
  return buffer;
}

/// The faces of all vertices.
std::vector<std::uint32_t> faces(const std::vector<float>& buffer, std::size_t size) {
  std::vector<std::uint32_t> faces;
  for_each_vertex(buffer, size,
                  [&](std::uint32_t face, double /*depth*/) { faces.push_back(face); });
  return faces;
}

}  // namespace

TEST(Feedback, ReadsPolygonsLinesAndPoints) {
  std::vector<float> buffer = triangle(3);
  buffer.push_back(GL_LINE_RESET_TOKEN);
  add_vertex(4, 0, buffer);
  add_vertex(4, 0, buffer);
  buffer.push_back(GL_POINT_TOKEN);
  add_vertex(5, 0, buffer);
  constexpr std::uint32_t kFace = 3 + (2 << 16);
  EXPECT_EQ(faces(buffer, buffer.size()),
            (std::vector<std::uint32_t>{kFace, kFace, kFace, 4, 4, 5}));
  EXPECT_TRUE(faces(buffer, 0).empty());
}

TEST(Feedback, ACutOffBufferIsRefused) {
  const std::vector<float> whole = triangle(3);
  for (std::size_t size = 1; size < whole.size(); ++size) {
    EXPECT_THROW(faces(whole, size), GlError) << size;
    EXPECT_THROW(faces({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}, size),
                 GlError)
        << size;
  }
}

TEST(Feedback, IllegalNumbersOfVerticesAndFacesAreRefused) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float vertices : {4.0f, -1.0f, 1e30f, nan, infinity, -infinity}) {
    EXPECT_THROW(faces(triangle(vertices), 35), GlError) << vertices;
  }
  for (const float half : {-1.0f, 65536.0f, nan, infinity}) {
    std::vector<float> lower = {GL_POINT_TOKEN}, upper = lower;
    add_vertex(half, 0, lower);
    add_vertex(0, half, upper);
    EXPECT_THROW(faces(lower, lower.size()), GlError) << half;
    EXPECT_THROW(faces(upper, upper.size()), GlError) << half;
  }
  EXPECT_THROW(faces({0.0f}, 1), GlError);
}

namespace {

/// A triangle whose corners have these barycentric coordinates.
void add_part(const std::vector<std::array<float, 2>>& corners, std::vector<float>& buffer) {
  buffer.insert(buffer.end(), {kPolygon, static_cast<float>(corners.size())});
  for (const auto& [first, second] : corners) add_vertex(first, second, buffer);
}

void add_mark(std::vector<float>& buffer) {
  buffer.insert(buffer.end(), {float{GL_PASS_THROUGH_TOKEN}, 0.0f});
}

}  // namespace

TEST(FaceParts, ThatGlHasSplitAreOnePolygon) {
  std::vector<float> buffer;
  add_mark(buffer);
  add_part({{0, 0}, {1, 0}, {0.75f, 0.25f}}, buffer);
  add_part({{0, 0}, {0.75f, 0.25f}, {0.25f, 0.75f}}, buffer);
  add_part({{0.25f, 0.75f}, {0, 1}, {0, 0}}, buffer);
  add_mark(buffer);
  add_mark(buffer);
  add_part({{0.5f, 0.5f}, {0.5f, 0.25f}, {0.25f, 0.5f}}, buffer);
  const std::vector<FacePart> parts = read_parts(buffer, buffer.size());
  ASSERT_EQ(parts.size(), 3U);
  const FacePart whole = {{0, 0}, {1, 0}, {0.75, 0.25}, {0.25, 0.75}, {0, 1}};
  ASSERT_EQ(parts[0].size(), whole.size());
  const auto first = std::find(parts[0].begin(), parts[0].end(), whole[0]) - parts[0].begin();
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_EQ(parts[0][(i + static_cast<std::size_t>(first)) % whole.size()], whole[i]) << i;
  }
  EXPECT_TRUE(parts[1].empty());
  EXPECT_EQ(parts[2].size(), 3U);
}

TEST(FaceParts, IllegalFeedbackIsRefused) {
  EXPECT_THROW(read_parts(triangle(3), 35), GlError) << "the token of a face is missing";
  for (const float share : {-1.0f, 2.0f, std::numeric_limits<float>::quiet_NaN()}) {
    std::vector<float> buffer;
    add_mark(buffer);
    add_part({{0, 0}, {1, 0}, {0, share}}, buffer);
    EXPECT_THROW(read_parts(buffer, buffer.size()), GlError) << share;
    EXPECT_THROW(read_parts(buffer, buffer.size() - 1), GlError);
  }
}
