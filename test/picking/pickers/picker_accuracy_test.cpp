// What the pickers of picker.hpp find, compared with a clip in double precision.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <functional>
#include <vector>

#include "picker_fixture.hpp"
#include "picking/volumes/paper_volumes.hpp"
#include "test/picking/volumes/clip_oracle.hpp"
#include "test/picking/volumes/random_motions.hpp"

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

}  // namespace
}  // namespace organ_collision
