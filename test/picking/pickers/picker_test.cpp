#include "picking/pickers/picker.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <functional>
#include <vector>

#include "picking/gl/gl_functions.hpp"
#include "test/picking/volumes/clip_oracle.hpp"
#include "test/picking/volumes/random_motions.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

// Triangles that share no vertex.
class Soup {
 public:
  void add(const Triangle& face) {
    for (const Vector3d& corner : face) {
      for (int k = 0; k < 3; ++k) vertices_.push_back(static_cast<float>(corner[k]));
    }
  }
  std::size_t size() const { return vertices_.size() / 9; }
  TriangleMesh mesh() const {
    std::vector<std::uint32_t> triangles(vertices_.size() / 3);
    for (std::size_t i = 0; i < triangles.size(); ++i) triangles[i] = static_cast<std::uint32_t>(i);
    return {vertices_, triangles};
  }

 private:
  std::vector<float> vertices_;
};

// [m] Largest coordinate of the mesh relative to a volume's origin.
double extent(const TriangleMesh& mesh, const Vector3d& origin) {
  double largest = 0;
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    largest = std::max(largest, (mesh.vertex(i) - origin).cwiseAbs().maxCoeff());
  }
  return largest;
}

std::vector<std::uint32_t> numbers(const std::vector<Candidate>& candidates) {
  std::vector<std::uint32_t> faces;
  for (const Candidate& candidate : candidates) faces.push_back(candidate.face);
  return faces;
}

class PickerTest : public testing::TestWithParam<PickerKind> {
 protected:
  std::vector<Candidate> pick(const ViewingVolume& volume, const TriangleMesh& mesh) {
    std::vector<Candidate> candidates{{7, 0, 0}};  // is to be replaced
    picker_->pick(volume, mesh, candidates);
    return candidates;
  }

  GlContext context_;
  std::unique_ptr<Picker> picker_ = make_picker(GetParam(), context_);
};

INSTANTIATE_TEST_SUITE_P(Kinds, PickerTest,
                         testing::Values(PickerKind::kFeedback, PickerKind::kSelect),
                         [](const auto& info) {
                           return info.param == PickerKind::kFeedback ? "Feedback" : "Select";
                         });

// A box of 2 m by 2 m by 2 m around a place off the frame's origin.
ViewingVolume box() {
  return ViewingVolume::orthographic(
      {Vector3d(3, -2, 5), Vector3d::Zero(), Eigen::Matrix3d::Identity(), -1, 1, -1, 1, -1, 1});
}

Triangle moved(const Triangle& face, const Vector3d& by) {
  return {face[0] + by, face[1] + by, face[2] + by};
}

// Random faces of all sizes about the tool, clipped by GL and in double precision.
void compare_with_oracle(Picker& picker, unsigned seed,
                         const std::function<ViewingVolume(const ShaftMotion&, double)>& build) {
  Random random(seed);
  int in = 0, out = 0, close = 0;
  std::vector<Candidate> candidates;
  for (int i = 0; i < 150; ++i) {
    const Vector3d trocar = random.magnitude(0.1, 100) * random.direction();
    const ShaftAxis start{trocar, trocar + random.uniform(0.05, 0.3) * random.direction()};
    ShaftMotion motion{start, start};
    motion.end.tip += random.magnitude(0.001, 0.2) * random.direction();
    const double radius = random.magnitude(0.001, 0.01);
    const ViewingVolume volume = build(motion, radius);
    Soup soup;
    for (int k = 0; k < 100; ++k) {
      const Vector3d centre = motion.at(random.uniform(0, 1)).at(random.uniform(-0.2, 1.3)) +
                              random.magnitude(1e-4, 0.1) * random.direction();
      const double size = random.magnitude(1e-4, 0.3);
      soup.add({centre + size * random.direction(), centre + size * random.direction(),
                centre + size * random.direction()});
    }
    const TriangleMesh mesh = soup.mesh();
    picker.pick(volume, mesh, candidates);
    const std::vector<std::uint32_t> picked = numbers(candidates);
    ASSERT_TRUE(std::is_sorted(picked.begin(), picked.end()));
    ASSERT_EQ(std::adjacent_find(picked.begin(), picked.end()), picked.end());

    const double band = 1e-5 * extent(mesh, volume.origin());
    for (std::uint32_t face = 0; face < mesh.face_count(); ++face) {
      const bool found = std::binary_search(picked.begin(), picked.end(), face);
      switch (verdict(volume, mesh.triangle(face), band)) {
        case Verdict::kIn:
          EXPECT_TRUE(found) << motion << "face " << face;
          ++in;
          break;
        case Verdict::kOut:
          EXPECT_FALSE(found) << motion << "face " << face;
          ++out;
          break;
        case Verdict::kClose:
          ++close;
      }
    }
  }
  EXPECT_GT(in, 1000);
  EXPECT_GT(out, 1000);
  EXPECT_LT(close, 200);
}

TEST_P(PickerTest, AgreesWithDoublePrecisionInThePaperStaticVolume) {
  compare_with_oracle(*picker_, 21, [](const ShaftMotion& motion, double radius) {
    return paper_static_volume(motion.end, radius);
  });
}

TEST_P(PickerTest, AgreesWithDoublePrecisionInThePaperSweptVolume) {
  compare_with_oracle(*picker_, 22, paper_swept_volume);
}

TEST_P(PickerTest, AgreesWithDoublePrecisionInThePaperNaiveVolume) {
  compare_with_oracle(*picker_, 23, paper_naive_volume);
}

TEST_P(PickerTest, AgreesWithDoublePrecisionInTheConservativeVolume) {
  compare_with_oracle(*picker_, 24, [](const ShaftMotion& motion, double radius) {
    return conservative_volume(motion, radius, {});
  });
}

TEST_P(PickerTest, AgreesWithDoublePrecisionAroundAMovingTrocar) {
  compare_with_oracle(*picker_, 25, [](ShaftMotion motion, double radius) {
    motion.end.trocar += 0.4 * (motion.end.tip - motion.start.tip);
    return conservative_volume(motion, radius, {});
  });
}

TEST_P(PickerTest, DepthRangesAreThoseOfTheClippedFaces) {
  Random random(26);
  int compared = 0;
  for (int i = 0; i < 200; ++i) {
    const Vector3d trocar = 0.3 * random.direction();
    const ShaftAxis start{trocar, trocar + random.uniform(0.05, 0.3) * random.direction()};
    const ShaftMotion motion{start,
                             {trocar, start.tip + random.uniform(0.005, 0.1) * random.direction()}};
    Soup soup;
    for (int k = 0; k < 50; ++k) {
      const Vector3d centre = motion.at(random.uniform(0, 1)).at(random.uniform(0.1, 1));
      soup.add({centre + random.uniform(0, 0.1) * random.direction(),
                centre + random.uniform(0, 0.1) * random.direction(),
                centre + random.uniform(0, 0.1) * random.direction()});
    }
    const TriangleMesh mesh = soup.mesh();
    for (const ViewingVolume& volume :
         {paper_static_volume(motion.end, 0.005), paper_swept_volume(motion, 0.005),
          paper_naive_volume(motion, 0.005)}) {
      const HalfSpace near = volume.half_space(4);
      for (const Candidate& candidate : pick(volume, mesh)) {
        const Triangle face = mesh.triangle(candidate.face);
        if (verdict(volume, face, 1e-6) != Verdict::kIn) continue;
        double nearest = 1e9, farthest = -1e9;
        for (const Vector3d& corner : clip_oracle(volume, face)) {
          const double depth = near.offset - near.normal.dot(corner);
          nearest = std::min(nearest, depth);
          farthest = std::max(farthest, depth);
        }
        // A face that is steep against the view turns a misplaced plane into a deeper one.
        const Vector3d normal = (face[1] - face[0]).cross(face[2] - face[0]).normalized();
        if (std::abs(normal.dot(near.normal)) < 0.2) continue;
        EXPECT_NEAR(candidate.view_min, nearest, 1e-5) << motion;
        EXPECT_NEAR(candidate.view_max, farthest, 1e-5) << motion;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 2000);
}

TEST_P(PickerTest, PicksDegenerateAndEdgeOnFacesThatTouch) {
  const Vector3d origin = box().origin();
  const Vector3d inside(0.25, -0.5, 0.125), far_left(-4, -0.5, 0.125), far_right(4, -0.5, 0.125);
  const Vector3d above(0.25, 3, 0.125), behind(0.25, -0.5, 7);
  const std::vector<std::pair<Triangle, bool>> faces = {
      {{inside, inside, inside}, true},         // a point
      {{far_left, far_left, far_left}, false},  //
      {{far_left, far_right, far_left}, true},  // a segment through the box
      {{far_left, far_left, far_right}, true},  //
      {{far_left, far_right, inside}, true},    // three corners on a line
      {{above, far_right, far_right}, false},   // a segment that passes by
      {{inside, behind, inside}, true},         // a segment along the view
      {{inside, behind, above}, true},          // a face edge-on to the view
      {{far_left, far_right, behind}, true},    //
      {{Vector3d(-1, -3, 0), Vector3d(-1, 3, 0), Vector3d(-5, 0, 0)}, true},  // touches a side
      {{Vector3d(1, 1, 1), Vector3d(5, 1, 1), Vector3d(1, 5, 3)}, true},      // touches a corner
  };
  Soup soup;
  std::vector<std::uint32_t> expected;
  for (const auto& [face, touches] : faces) {
    // Both orientations and every order of the corners.
    for (const auto& order : {std::array{0, 1, 2}, std::array{2, 1, 0}, std::array{1, 2, 0},
                              std::array{0, 2, 1}, std::array{1, 0, 2}, std::array{2, 0, 1}}) {
      if (touches) expected.push_back(static_cast<std::uint32_t>(soup.size()));
      soup.add(
          moved({face[static_cast<std::size_t>(order[0])], face[static_cast<std::size_t>(order[1])],
                 face[static_cast<std::size_t>(order[2])]},
                origin));
    }
  }
  EXPECT_EQ(numbers(pick(box(), soup.mesh())), expected);
}

TEST_P(PickerTest, GrowsItsBufferUntilAllHitsFit) {
  Random random(27);
  Soup soup;
  for (int i = 0; i < 70'000; ++i) {
    const Vector3d centre = box().origin() + 0.5 * random.direction();
    soup.add({centre, centre + 0.1 * random.direction(), centre + 2 * random.direction()});
  }
  const TriangleMesh mesh = soup.mesh();
  const std::vector<Candidate> candidates = pick(box(), mesh);
  ASSERT_EQ(candidates.size(), soup.size());
  for (std::uint32_t i = 0; i < candidates.size(); ++i) ASSERT_EQ(candidates[i].face, i);
}

TEST_P(PickerTest, FindsNothingWhereNothingIs) {
  Soup soup;
  soup.add(moved({Vector3d(2, 0, 0), Vector3d(2, 1, 0), Vector3d(2, 0, 1)}, box().origin()));
  EXPECT_TRUE(pick(box(), soup.mesh()).empty());
}

TEST_P(PickerTest, ThrowsWhenGlFailed) {
  Soup soup;
  soup.add({box().origin(), box().origin() + Vector3d(0.1, 0, 0), box().origin()});
  const TriangleMesh mesh = soup.mesh();
  context_.functions().Enable(0xdead);
  std::vector<Candidate> candidates{{7, 0, 0}};
  EXPECT_THROW(picker_->pick(box(), mesh, candidates), GlError);
  EXPECT_TRUE(candidates.empty());
  EXPECT_EQ(numbers(pick(box(), mesh)), std::vector<std::uint32_t>{0});
}

TEST_P(PickerTest, RefusesAContextThatPicksWrongly) {
  context_.make_current();
  constexpr double kNothing[] = {0, 0, 0, -1};
  context_.functions().ClipPlane(GL_CLIP_PLANE5, kNothing);
  context_.functions().Enable(GL_CLIP_PLANE5);
  EXPECT_THROW(make_picker(GetParam(), context_), GlError);
}

// One draw for each vertex order of the same face; the answer does not depend on it.
TEST_P(PickerTest, AnswersDoNotDependOnEarlierQueries) {
  Random random(28);
  std::unique_ptr<Picker> other = make_picker(
      GetParam() == PickerKind::kSelect ? PickerKind::kFeedback : PickerKind::kSelect, context_);
  std::vector<Candidate> ignored;
  const ShaftMotion motion = random_motion(MotionKind::kSideways, 0.3, random);
  Soup soup;
  for (int k = 0; k < 200; ++k) {
    const Vector3d centre = motion.at(random.uniform(0, 1)).at(random.uniform(0, 1.1));
    soup.add({centre, centre + 0.02 * random.direction(), centre + 0.02 * random.direction()});
  }
  const TriangleMesh mesh = soup.mesh();
  const ViewingVolume plain = paper_static_volume(motion.end, 0.004);
  const ViewingVolume planes = paper_swept_volume(motion, 0.004);
  const std::vector<std::uint32_t> expected_plain = numbers(pick(plain, mesh));
  const std::vector<std::uint32_t> expected_planes = numbers(pick(planes, mesh));
  EXPECT_NE(expected_plain, expected_planes);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(numbers(pick(planes, mesh)), expected_planes);
    other->pick(planes, mesh, ignored);
    EXPECT_EQ(numbers(pick(plain, mesh)), expected_plain);
    other->pick(plain, mesh, ignored);
  }
}

TEST(Picker, KindsHaveNames) {
  EXPECT_EQ(picker_kind("feedback"), PickerKind::kFeedback);
  EXPECT_EQ(picker_kind("select"), PickerKind::kSelect);
  for (const char* name : {"", "Feedback", "both"}) {
    try {
      picker_kind(name);
      FAIL() << name;
    } catch (const std::invalid_argument& error) {
      const std::string what = error.what();
      EXPECT_NE(what.find("\"" + std::string(name) + "\""), std::string::npos) << what;
      EXPECT_NE(what.find("\"feedback\" or \"select\""), std::string::npos) << what;
    }
  }
}

}  // namespace
}  // namespace organ_collision
