#include "picking/volumes/part_sweep.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "picking/pickers/picker.hpp"
#include "random_boxes.hpp"
#include "random_motions.hpp"
#include "test/grid_surface.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

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
