#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "organ_collision/query/collision_query.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision {

struct Soup {
  std::vector<float> vertices;
  std::vector<std::uint32_t> triangles;
};

inline TriangleMesh mesh(const Soup& soup) { return {soup.vertices, soup.triangles}; }

/// Scattered faces of many sizes. Some share corners.
inline Soup scattered_faces(std::size_t count, oracle::Random& random) {
  Soup soup;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d center = random.point(0.12);
    const double size = random.scale(1e-3, 0.05);
    for (int corner = 0; corner < 3; ++corner) {
      const Eigen::Vector3d vertex = center + size * random.direction();
      for (int k = 0; k < 3; ++k) soup.vertices.push_back(static_cast<float>(vertex[k]));
      const bool common = i > 0 && random.chance(0.2);
      soup.triangles.push_back(common ? random.integer(0, 3 * i - 1) : 3 * i + corner);
    }
  }
  return soup;
}

inline Soup shaken(const Soup& soup, double by, oracle::Random& random) {
  Soup moved = soup;
  for (float& x : moved.vertices) x += static_cast<float>(random.uniform(-by, by));
  return moved;
}

/// A closed bumpy surface, about 0.2 m long, with as many faces as the paper's liver: 1224.
inline Soup liver() {
  constexpr int kRings = 17, kSectors = 36;
  Soup soup;
  const auto add = [&](double polar, double around) {
    const double bump =
        1.0 + 0.2 * std::sin(3 * around) * std::sin(polar) + 0.1 * std::cos(4 * polar);
    const Eigen::Vector3d p(0.1 * std::sin(polar) * std::cos(around),
                            0.06 * std::sin(polar) * std::sin(around), 0.04 * std::cos(polar));
    for (int k = 0; k < 3; ++k) soup.vertices.push_back(static_cast<float>(bump * p[k]));
  };
  add(0.0, 0.0);
  for (int ring = 1; ring <= kRings; ++ring)
    for (int sector = 0; sector < kSectors; ++sector)
      add(M_PI * ring / (kRings + 1), 2 * M_PI * sector / kSectors);
  add(M_PI, 0.0);
  const auto vertex = [](int ring, int sector) {
    return static_cast<std::uint32_t>(1 + ring * kSectors + sector % kSectors);
  };
  const std::uint32_t last = 1 + kRings * kSectors;
  for (int sector = 0; sector < kSectors; ++sector) {
    const auto add_face = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      soup.triangles.insert(soup.triangles.end(), {a, b, c});
    };
    add_face(0, vertex(0, sector), vertex(0, sector + 1));
    for (int ring = 0; ring + 1 < kRings; ++ring) {
      add_face(vertex(ring, sector), vertex(ring + 1, sector), vertex(ring + 1, sector + 1));
      add_face(vertex(ring, sector), vertex(ring + 1, sector + 1), vertex(ring, sector + 1));
    }
    add_face(vertex(kRings - 1, sector), last, vertex(kRings - 1, sector + 1));
  }
  return soup;
}

inline ShaftAxis random_axis(oracle::Random& random) {
  return {Eigen::Vector3d(0.0, 0.0, 0.25) + random.point(0.05), random.point(0.1)};
}

/// A path of a shaft with a resting or moving trocar, of one to three legs.
inline ToolPath random_path(bool trocar_moves, oracle::Random& random) {
  ToolPath path = {{0.0, random_axis(random)}};
  const int legs = random.integer(1, 3);
  for (int leg = 1; leg <= legs; ++leg) {
    ShaftAxis next = path.back().axis;
    next.tip += random.scale(1e-4, 0.1) * random.direction();
    if (trocar_moves) next.trocar += random.scale(1e-5, 0.01) * random.direction();
    path.push_back({leg == legs ? 1.0 : static_cast<double>(leg) / legs, next});
  }
  return path;
}

inline CollisionRequest swept(const TriangleMesh& organ, const ToolPath& path, double radius) {
  CollisionRequest request;
  request.organ = &organ;
  request.path = path;
  request.radius = radius;
  request.mode = QueryMode::kSwept;
  return request;
}

inline void expect_same(const FaceContact& a, const FaceContact& b, double slack) {
  EXPECT_EQ(a.face, b.face);
  EXPECT_NEAR(a.fraction, b.fraction, slack);
  EXPECT_LE((a.point - b.point).norm(), slack) << "face " << a.face;
  EXPECT_LE((a.normal - b.normal).norm(), slack) << "face " << a.face;
  EXPECT_LE((a.barycentric - b.barycentric).norm(), slack) << "face " << a.face;
  EXPECT_NEAR(a.shaft, b.shaft, slack);
  EXPECT_NEAR(a.depth, b.depth, slack);
  EXPECT_EQ(a.behind, b.behind);
  EXPECT_LE((a.end_point - b.end_point).norm(), slack) << "face " << a.face;
}

inline void expect_same(const std::vector<FaceContact>& a, const std::vector<FaceContact>& b,
                        double slack) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) expect_same(a[i], b[i], slack);
}

/// A query with one of the pickers.
class CollisionQueryWith : public testing::TestWithParam<PickerKind> {
 protected:
  std::vector<FaceContact> contacts(const CollisionRequest& request) {
    query_.evaluate(request, result_);
    EXPECT_EQ(result_.unresolved, 0U) << "the work that a query may cost was used up";
    return result_.contacts;
  }

  CollisionQuery query_{GetParam()};
  CollisionResult result_;
};

}  // namespace organ_collision
