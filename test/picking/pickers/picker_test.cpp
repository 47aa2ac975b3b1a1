#include "picking/pickers/picker.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "organ_collision/picking/picker_settings.hpp"
#include "picker_fixture.hpp"
#include "picking/volumes/conservative_volume.hpp"
#include "picking/volumes/paper_volumes.hpp"
#include "test/grid_surface.hpp"
#include "test/picking/volumes/clip_oracle.hpp"
#include "test/picking/volumes/random_motions.hpp"
#include "test/resident_memory.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

INSTANTIATE_TEST_SUITE_P(Kinds, PickerTest,
                         testing::Values(PickerKind::kFeedback, PickerKind::kSelect,
                                         PickerKind::kCpu),
                         picker_name);

// A box of 2 m by 2 m by 2 m whose center is not the frame's origin.
ViewingVolume box() {
  return ViewingVolume::orthographic(
      {Vector3d(3, -2, 5), Vector3d::Zero(), Eigen::Matrix3d::Identity(), -1, 1, -1, 1, -1, 1});
}

Triangle moved(const Triangle& face, const Vector3d& by) {
  return {face[0] + by, face[1] + by, face[2] + by};
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
    // Every order of the corners.
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

TEST_P(PickerTest, AnswersDoNotDependOnEarlierQueries) {
  Random random(28);
  const std::unique_ptr<Picker> other =
      make_picker(GetParam() == PickerKind::kSelect ? PickerKind::kFeedback : PickerKind::kSelect);
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

// If faces were drawn by glBegin in GL_SELECT mode, Mesa would lose a buffer of 512 KB after every
// 2200 such queries.
TEST_P(PickerTest, TakesNoMemoryForEachQuery) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "memory that is freed stays with the sanitizer";
#endif
  Soup soup;
  for (int i = 0; i < 5; ++i) {
    soup.add(
        moved({Vector3d(-4, 0, 0.1 * i), Vector3d(4, 0, 0), Vector3d(0, 4, 0)}, box().origin()));
  }
  const TriangleMesh mesh = soup.mesh();
  std::vector<Candidate> candidates;
  long before = 0;
  for (int i = 0; i < 24'000; ++i) {
    if (i == 4000) before = resident_memory();
    picker_->pick(box(), mesh, candidates);
    ASSERT_EQ(candidates.size(), soup.size());
  }
  EXPECT_LT(resident_memory() - before, 2'000'000);
}

TEST(Picker, WithoutOpenGlSaysSo) {
  const std::unique_ptr<Picker> picker = make_picker(PickerKind::kCpu);
  EXPECT_EQ(picker->gl_version(), "none (picker: cpu)");
}

}  // namespace

}  // namespace organ_collision

// What the pickers of picker.hpp find, compared with a clip in double precision.

namespace organ_collision {
namespace {

using Eigen::Vector3d;

using PickerAccuracy = PickerTest;

INSTANTIATE_TEST_SUITE_P(Kinds, PickerAccuracy,
                         testing::Values(PickerKind::kFeedback, PickerKind::kSelect,
                                         PickerKind::kCpu),
                         picker_name);

// [m] The largest coordinate of the mesh relative to a volume's origin.
double extent(const TriangleMesh& mesh, const Vector3d& origin) {
  double largest = 0;
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    largest = std::max(largest, (mesh.vertex(i) - origin).cwiseAbs().maxCoeff());
  }
  return largest;
}

// Compares what GL picks with a clip in double precision, for random faces of all sizes around the
// tool.
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

TEST_P(PickerAccuracy, AgreesWithDoublePrecisionInThePaperStaticVolume) {
  compare_with_oracle(*picker_, 21, [](const ShaftMotion& motion, double radius) {
    return paper_static_volume(motion.end, radius);
  });
}

TEST_P(PickerAccuracy, AgreesWithDoublePrecisionInThePaperSweptVolume) {
  compare_with_oracle(*picker_, 22, paper_swept_volume);
}

TEST_P(PickerAccuracy, AgreesWithDoublePrecisionInThePaperNaiveVolume) {
  compare_with_oracle(*picker_, 23, paper_naive_volume);
}

TEST_P(PickerAccuracy, AgreesWithDoublePrecisionInTheConservativeVolume) {
  compare_with_oracle(*picker_, 24, [](const ShaftMotion& motion, double radius) {
    return conservative_volume(motion, radius, {});
  });
}

TEST_P(PickerAccuracy, AgreesWithDoublePrecisionAroundAMovingTrocar) {
  compare_with_oracle(*picker_, 25, [](ShaftMotion motion, double radius) {
    motion.end.trocar += 0.4 * (motion.end.tip - motion.start.tip);
    return conservative_volume(motion, radius, {});
  });
}

TEST_P(PickerAccuracy, DepthRangesAreThoseOfTheClippedFaces) {
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
        // If a face is steep against the view, a small error of a plane becomes a large error of
        // depth.
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

TEST(PickerSettings, KindsHaveNames) {
  EXPECT_EQ(picker_kind("feedback"), PickerKind::kFeedback);
  EXPECT_EQ(picker_kind("select"), PickerKind::kSelect);
  EXPECT_EQ(picker_kind("cpu"), PickerKind::kCpu);
}

TEST(PickerSettings, PlatformsHaveNames) {
  EXPECT_EQ(gl_platform("auto"), GlPlatform::kAuto);
  EXPECT_EQ(gl_platform("osmesa"), GlPlatform::kOsmesa);
  EXPECT_EQ(gl_platform("egl"), GlPlatform::kEgl);
}

/// Expects that parse(name) throws, and names the value and what is legal.
template <typename Parse>
void expect_refused(Parse parse, const std::string& name, const std::string& legal) {
  try {
    parse(name);
    FAIL() << name;
  } catch (const std::invalid_argument& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("\"" + name + "\""), std::string::npos) << what;
    EXPECT_NE(what.find(legal), std::string::npos) << what;
  }
}

TEST(PickerSettings, OtherNamesAreRefused) {
  for (const char* name : {"", "Feedback", "both", "GPU"}) {
    expect_refused(picker_kind, name, "\"feedback\", \"select\" or \"cpu\"");
    expect_refused(gl_platform, name, "\"auto\", \"osmesa\" or \"egl\"");
  }
}

TEST(PickerSettings, AreFeedbackWithAnyOpenGlByDefault) {
  EXPECT_EQ(PickerSettings().kind, PickerKind::kFeedback);
  EXPECT_EQ(PickerSettings(PickerKind::kSelect).gl, GlPlatform::kAuto);
}

/// Moving faces. Each passes through a given point at a given time.
struct MovingFaces {
  std::vector<float> before, after;
  std::vector<std::uint32_t> triangles;

  /// Adds a face that contains `point` at `time` and whose corners move by about `move` [m].
  void add(const Vector3d& point, double time, double size, double move, Random& random) {
    const Vector3d velocity = move * random.direction();
    const Vector3d a = size * random.direction(), b = size * random.direction();
    const double u = random.uniform(0, 1), v = random.uniform(0, 1 - u);
    for (const Vector3d& corner :
         {Vector3d(point - u * a - v * b), Vector3d(point + (1 - u) * a - v * b),
          Vector3d(point - u * a + (1 - v) * b)}) {
      const Vector3d own = velocity + 0.3 * move * random.direction();
      for (int k = 0; k < 3; ++k) {
        before.push_back(static_cast<float>(corner[k] - time * own[k]));
        after.push_back(static_cast<float>(corner[k] + (1 - time) * own[k]));
      }
      triangles.push_back(static_cast<std::uint32_t>(triangles.size()));
    }
  }
};

double some_move(Random& random) {
  return random.below(4) == 0 ? 0.0 : random.magnitude(1e-6, 0.5);
}

class PartSweepWith : public testing::TestWithParam<PickerKind> {
 protected:
  std::vector<std::uint32_t> pick(const PartSweep& part, const OrganMotion& organ) {
    picker_->pick(part, organ, candidates_);
    std::vector<std::uint32_t> faces;
    for (const Candidate& candidate : candidates_) faces.push_back(candidate.face);
    EXPECT_TRUE(std::is_sorted(faces.begin(), faces.end()));
    EXPECT_EQ(std::adjacent_find(faces.begin(), faces.end()), faces.end());
    return faces;
  }

  std::unique_ptr<Picker> picker_ = make_picker(GetParam());
  std::vector<Candidate> candidates_;
};

// The part moves during a fraction of the step, from `begin` to `finish`. Only the motion of the
// faces in that fraction counts.
TEST_P(PartSweepWith, MissesNoMovingFaceThatComesNearAShaft) {
  Random random(41);
  for (const MotionKind kind : kMotionKinds) {
    for (int trial = 0; trial < 12; ++trial) {
      const ShaftMotion motion = random_motion(kind, random.magnitude(0.01, 1.0), random);
      const double radius = random.magnitude(5e-4, 0.01);
      const double begin = random.uniform(0.0, 0.9), finish = random.uniform(begin + 0.05, 1.0);
      MovingFaces faces;
      for (int i = 0; i < 40; ++i) {
        const double time = random.uniform(0, 1);
        const ShaftAxis axis = motion.at(time);
        const Vector3d on_tool =
            axis.at(random.uniform(0, 1)) + 0.999 * radius * random.direction();
        faces.add(on_tool, begin + time * (finish - begin), random.magnitude(1e-4, 0.1),
                  some_move(random), random);
      }
      const TriangleMesh after(faces.after, faces.triangles);
      TriangleMesh before = after;
      before.move_vertices(faces.before);
      const OrganMotion organ(before, before.block_boxes(), after, begin, finish);
      EXPECT_EQ(pick(PartSweep(motion, radius), organ).size(), 40U)
          << "kind " << static_cast<int>(kind);
    }
  }
}

TEST_P(PartSweepWith, MissesNoMovingFaceThatComesNearABox) {
  Random random(42);
  for (int trial = 0; trial < 150; ++trial) {
    const MovingBox moving = random_box(random.magnitude(0.01, 1.0), random);
    const RigidMotion motion = moving.motion();
    const SweptBox box(moving.box, motion, moving.radius);
    MovingFaces faces;
    for (int i = 0; i < 40; ++i) {
      const double time = random.uniform(0, 1);
      Vector3d corner = moving.box.half_size;
      for (int k = 0; k < 3; ++k) corner[k] *= random.uniform(-1, 1);
      const Vector3d on_box = motion.at(time) * (moving.box.center + moving.box.axes * corner);
      faces.add(on_box, time, random.magnitude(1e-4, 0.1), some_move(random), random);
    }
    const TriangleMesh after(faces.after, faces.triangles);
    TriangleMesh before = after;
    before.move_vertices(faces.before);
    const OrganMotion organ(before, before.block_boxes(), after, 0.0, 1.0);
    EXPECT_EQ(pick(PartSweep(box), organ).size(), 40U) << "trial " << trial;
  }
}

// A vertex that jumps adds only its own faces to the candidates, however far it jumps.
TEST_P(PartSweepWith, OneVertexThatJumpsConcernsItsOwnFacesOnly) {
  Random random(43);
  const GridSurface grid = grid_surface(60);
  const TriangleMesh after(grid.vertices, grid.triangles());
  for (const double jump : {0.0, 0.1, 10.0, 1e5}) {
    for (int trial = 0; trial < 10; ++trial) {
      const Vector3d tip = after.vertex(static_cast<std::size_t>(random.below(3600)));
      const Vector3d trocar = tip + Vector3d(0.05, 0.03, 0.3);
      const ShaftMotion motion{{trocar, tip}, {trocar, tip + 0.002 * random.direction()}};
      const PartSweep part(motion, 0.005);
      const std::vector<std::uint32_t> resting = pick(part, OrganMotion(after));
      std::vector<float> vertices = grid.vertices;
      vertices[static_cast<std::size_t>(3 * random.below(3600) + random.below(3))] +=
          static_cast<float>(jump);
      TriangleMesh before = after;
      before.move_vertices(vertices);
      const std::vector<std::uint32_t> moving =
          pick(part, OrganMotion(before, before.block_boxes(), after, 0.0, 1.0));
      EXPECT_TRUE(std::includes(moving.begin(), moving.end(), resting.begin(), resting.end()));
      EXPECT_LE(moving.size(), resting.size() + 12) << "jump " << jump;
      // The same for the resting shape after the jump.
      const std::vector<std::uint32_t> back = pick(part, OrganMotion(before));
      EXPECT_LE(back.size(), resting.size() + 12) << "jump " << jump;
    }
  }
}

// If the organ jumps, the candidates for a fraction of the step follow from the motion in that
// fraction.
TEST_P(PartSweepWith, AJumpIsDividedIntoFractions) {
  const GridSurface grid = grid_surface(60);
  const TriangleMesh after(grid.vertices, grid.triangles());
  TriangleMesh before = after;
  std::vector<float> vertices = grid.vertices;
  for (std::size_t i = 0; i < vertices.size(); i += 3) vertices[i] -= 0.5F;
  before.move_vertices(vertices);
  const Vector3d tip = after.vertex(1830);
  const ShaftAxis axis{tip + Vector3d(0.05, 0.03, 0.3), tip};
  const ShaftMotion resting{axis, axis};
  const PartSweep part(resting, 0.005);
  const std::size_t whole =
      pick(part, OrganMotion(before, before.block_boxes(), after, 0.0, 1.0)).size();
  std::size_t fractions = 0;
  for (int i = 0; i < 50; ++i) {
    const OrganMotion fraction(before, before.block_boxes(), after, i / 50.0, (i + 1) / 50.0);
    fractions += pick(part, fraction).size();
  }
  EXPECT_GT(whole, 20U);
  EXPECT_LT(fractions, 50 * whole / 4);
}

INSTANTIATE_TEST_SUITE_P(Pickers, PartSweepWith,
                         testing::Values(PickerKind::kFeedback, PickerKind::kSelect,
                                         PickerKind::kCpu));

}  // namespace

}  // namespace organ_collision

// Compares the pickers on OSMesa with those on EGL.

namespace organ_collision {
namespace {

using Eigen::Vector3d;

class GlPlatforms : public testing::TestWithParam<PickerKind> {
 protected:
  /// Expects the same candidates, bit for bit.
  void expect_same() const {
    ASSERT_EQ(on_osmesa_.size(), on_egl_.size());
    for (std::size_t i = 0; i < on_osmesa_.size(); ++i) {
      ASSERT_EQ(on_osmesa_[i].face, on_egl_[i].face);
      ASSERT_EQ(on_osmesa_[i].view_min, on_egl_[i].view_min);
      ASSERT_EQ(on_osmesa_[i].view_max, on_egl_[i].view_max);
    }
  }

  std::unique_ptr<Picker> osmesa_ = make_picker({GetParam(), GlPlatform::kOsmesa});
  std::unique_ptr<Picker> egl_ = make_picker({GetParam(), GlPlatform::kEgl});
  std::vector<Candidate> on_osmesa_, on_egl_;
};

INSTANTIATE_TEST_SUITE_P(Kinds, GlPlatforms,
                         testing::Values(PickerKind::kFeedback, PickerKind::kSelect), picker_name);

/// Faces near a moving shaft, of which it meets about a half.
TriangleMesh faces_near(const ShaftMotion& motion, double radius, Random& random) {
  Soup soup;
  for (int i = 0; i < 60; ++i) {
    const Vector3d on_axis = motion.at(random.uniform(0, 1)).at(random.uniform(0, 1.1));
    const Vector3d corner = on_axis + random.uniform(0, 3) * radius * random.direction();
    soup.add({corner, corner + 0.02 * random.direction(), corner + 0.02 * random.direction()});
  }
  return soup.mesh();
}

TEST_P(GlPlatforms, PickTheSameBitForBit) {
  Random random(71);
  std::size_t picked = 0;
  for (int i = 0; i < 1500; ++i) {
    const MotionKind kind = kMotionKinds[static_cast<std::size_t>(i) % kMotionKinds.size()];
    const ShaftMotion motion = random_motion(kind, i % 2 == 0 ? 0.3 : 200, random);
    const double radius = random.magnitude(5e-4, 0.01);
    const TriangleMesh mesh = faces_near(motion, radius, random);

    const ViewingVolume volume = conservative_volume(motion, radius, {});
    osmesa_->pick(volume, mesh, on_osmesa_);
    osmesa_->release();
    egl_->pick(volume, mesh, on_egl_);
    egl_->release();
    expect_same();
    picked += on_osmesa_.size();

    osmesa_->pick(PartSweep(motion, radius), OrganMotion(mesh), on_osmesa_);
    osmesa_->release();
    egl_->pick(PartSweep(motion, radius), OrganMotion(mesh), on_egl_);
    egl_->release();
    expect_same();
  }
  EXPECT_GT(picked, 20'000u);
}

}  // namespace

}  // namespace organ_collision
