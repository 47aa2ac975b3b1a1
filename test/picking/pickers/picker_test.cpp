// What each picker does beyond finding the right faces. The proofs compare what all pickers find
// with exact half-spaces and with exact distances.
#include "picking/pickers/picker.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "organ_collision/picking/picker_settings.hpp"
#include "picker_fixture.hpp"
#include "picking/volumes/conservative_volume.hpp"
#include "picking/volumes/paper_volumes.hpp"
#include "test/grid_surface.hpp"
#include "test/picking/volumes/random_motions.hpp"
#include "test/proof/exact_sides.hpp"
#include "test/refusals.hpp"
#include "test/resident_memory.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

INSTANTIATE_TEST_SUITE_P(Pickers, PickerTest, PickerTest::all(), PickerTest::name);

// A box of 2 m by 2 m by 2 m whose center is not the frame's origin.
ViewingVolume box_volume() {
  return ViewingVolume::orthographic(
      {Vector3d(3, -2, 5), Vector3d::Zero(), Eigen::Matrix3d::Identity(), -1, 1, -1, 1, -1, 1});
}

/// A tool whose tip moves, while its trocar rests.
ShaftMotion swing(Random& random) {
  const Vector3d trocar = 0.3 * random.direction();
  const Vector3d tip = trocar + random.uniform(0.05, 0.3) * random.direction();
  return {{trocar, tip}, {trocar, tip + random.uniform(0.005, 0.1) * random.direction()}};
}

/// Faces of about this size [m] near a moving shaft, of which many meet it.
TriangleMesh faces_near(const ShaftMotion& motion, std::size_t count, double size, Random& random) {
  std::vector<Triangle> faces(count);
  for (Triangle& face : faces) {
    const Vector3d on_axis = motion.at(random.uniform(0, 1)).at(random.uniform(0.1, 1.1));
    for (Vector3d& corner : face) corner = on_axis + random.uniform(0, size) * random.direction();
  }
  return oracle::mesh_of(faces);
}

TEST_P(PickerTest, GrowsItsBufferUntilAllHitsFit) {
  Random random(27);
  std::vector<Triangle> faces(70'000);
  for (Triangle& face : faces) {
    const Vector3d centre = box_volume().origin() + 0.5 * random.direction();
    face = {centre, centre + 0.1 * random.direction(), centre + 2 * random.direction()};
  }
  const std::vector<Candidate> candidates = pick(box_volume(), oracle::mesh_of(faces));
  ASSERT_EQ(candidates.size(), faces.size());
  for (std::uint32_t i = 0; i < candidates.size(); ++i) ASSERT_EQ(candidates[i].face, i);
}

TEST_P(PickerTest, AnswersDoNotDependOnEarlierQueries) {
  Random random(28);
  const bool selects = GetParam().kind == PickerKind::kSelect;
  const auto other = make_picker(selects ? PickerKind::kFeedback : PickerKind::kSelect);
  std::vector<Candidate> ignored;
  const ShaftMotion motion = swing(random);
  const TriangleMesh mesh = faces_near(motion, 200, 0.02, random);
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
  const Vector3d at = box_volume().origin();
  const Triangle face = {at + Vector3d(-4, 0, 0.1), at + Vector3d(4, 0, 0), at + Vector3d(0, 4, 0)};
  const TriangleMesh mesh = oracle::mesh_of(std::vector<Triangle>(5, face));
  std::vector<Candidate> candidates;
  long before = 0;
  for (int i = 0; i < 24'000; ++i) {
    if (i == 4000) before = resident_memory();
    picker_->pick(box_volume(), mesh, candidates);
    ASSERT_EQ(candidates.size(), 5U);
  }
  EXPECT_LT(resident_memory() - before, 2'000'000);
}

TEST(Picker, WithoutOpenGlSaysSo) {
  const std::unique_ptr<Picker> picker = make_picker(PickerKind::kCpu);
  EXPECT_EQ(picker->gl_version(), "none (picker: cpu)");
}

TEST_P(PickerTest, DepthRangesAreThoseOfTheClippedFaces) {
  Random random(26);
  int compared = 0;
  for (int i = 0; i < 200; ++i) {
    const ShaftMotion motion = swing(random);
    const TriangleMesh mesh = faces_near(motion, 50, 0.1, random);
    for (const ViewingVolume& volume :
         {paper_static_volume(motion.end, 0.005), paper_swept_volume(motion, 0.005),
          paper_naive_volume(motion, 0.005)}) {
      const HalfSpace near = volume.half_space(4);
      std::vector<HalfSpace> well_inside;
      for (std::size_t k = 0; k < volume.half_space_count(); ++k) {
        well_inside.push_back(volume.half_space(k));
        well_inside.back().offset -= 1e-6;
      }
      for (const Candidate& candidate : pick(volume, mesh)) {
        const Triangle face = mesh.triangle(candidate.face);
        if (!oracle::meets(face, volume.origin(), well_inside)) continue;
        double nearest = 1e9, farthest = -1e9;
        for (const Vector3d& corner : clipped(shifted(face, volume.origin()), volume)) {
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

TEST_P(PickerTest, PicksTheSameOnBothPlatformsBitForBit) {
  Random random(71);
  const auto on_osmesa = make_picker({GetParam().kind, GlPlatform::kOsmesa});
  std::vector<Candidate> expected, found;
  const auto expect_same = [&](const auto& what, const auto& organ) {
    on_osmesa->pick(what, organ, expected);
    on_osmesa->release();
    picker_->pick(what, organ, found);
    picker_->release();
    ASSERT_EQ(expected.size(), found.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      ASSERT_EQ(expected[i].face, found[i].face);
      ASSERT_EQ(expected[i].view_min, found[i].view_min);
      ASSERT_EQ(expected[i].view_max, found[i].view_max);
    }
  };
  std::size_t picked = 0;
  for (int i = 0; i < 1500; ++i) {
    const ShaftMotion motion = random_motion(motion_kind(i), i % 2 == 0 ? 0.3 : 200, random);
    const double radius = random.scale(5e-4, 0.01);
    const TriangleMesh mesh = faces_near(motion, 60, 3 * radius, random);
    expect_same(PartSweep(motion, radius), OrganMotion(mesh));
    expect_same(PartSweep(motion, radius).volume({}), mesh);
    picked += found.size();
  }
  EXPECT_GT(picked, 20'000u);
}

// A vertex that jumps adds only its own faces to the candidates, however far it jumps.
TEST_P(PickerTest, OneVertexThatJumpsConcernsItsOwnFacesOnly) {
  Random random(43);
  const GridSurface grid = grid_surface(60);
  const TriangleMesh after(grid.vertices, grid.triangles());
  for (const double jump : {0.0, 0.1, 10.0, 1e5}) {
    for (int trial = 0; trial < 10; ++trial) {
      const Vector3d tip = after.vertex(static_cast<std::size_t>(random.integer(0, 3599)));
      const Vector3d trocar = tip + Vector3d(0.05, 0.03, 0.3);
      const ShaftMotion motion{{trocar, tip}, {trocar, tip + 0.002 * random.direction()}};
      const PartSweep part(motion, 0.005);
      const std::vector<std::uint32_t> resting = pick(part, OrganMotion(after));
      std::vector<float> vertices = grid.vertices;
      vertices[static_cast<std::size_t>(random.integer(0, 3 * 3600 - 1))] +=
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

// Faces beside a shaft at rest, which they touch with the middle of an edge, and only at the
// beginning or at the end of their motion: no corner is ever inside. Half way, where they are
// drawn, they are up to 0.4 of its radius away.
TEST_P(PickerTest, FacesThatComeOrGoAreNeverMissed) {
  Random random(44);
  for (int trial = 0; trial < 2000; ++trial) {
    const Vector3d trocar = random.point(0.2), along = random.direction();
    const Vector3d outward = along.cross(random.direction()).normalized();
    const Vector3d tip = trocar + random.uniform(0.05, 0.3) * along;
    const double radius = random.scale(0.5e-3, 0.01);
    const Vector3d middle = trocar + random.uniform(0.1, 0.9) * (tip - trocar);
    const Vector3d touched = middle + 0.98 * radius * outward;
    const Vector3d side = 4.0 * radius * along.cross(outward), lift = 4.0 * radius * outward;
    const auto face_at = [&](const Vector3d& place) {
      return oracle::mesh_of({Triangle{place + lift, place + side, place - side}});
    };
    const TriangleMesh near = face_at(touched);
    const TriangleMesh far = face_at(touched + random.uniform(0.1, 0.8) * radius * outward);
    const bool comes = random.chance(0.5);
    TriangleMesh after = near;
    if (!comes) after.move_vertices(far.vertices());
    const TriangleMesh& before = comes ? far : near;
    const PartSweep part(ShaftMotion{{trocar, tip}, {trocar, tip}}, radius);
    const OrganMotion motion(before, before.block_boxes(), after, 0.0, 1.0);
    EXPECT_EQ(pick(part, motion), std::vector<std::uint32_t>{0}) << trial;
  }
}

}  // namespace
}  // namespace organ_collision
