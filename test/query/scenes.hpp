#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/distance/first_touch.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "query/moving_part.hpp"
#include "test/closed_surfaces.hpp"
#include "test/geometry/tool/tool_meshes.hpp"
#include "test/proof/exact_distance.hpp"
#include "test/proof/step_oracle.hpp"

/// Organs and tools for the tests of queries.
namespace organ_collision {

inline TriangleMesh mesh(const GridSurface& surface) {
  return {surface.vertices, surface.triangles()};
}

/// Scattered faces of many sizes. Some share corners.
inline GridSurface scattered_faces(std::uint32_t count, oracle::Random& random) {
  GridSurface soup;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Eigen::Vector3d center = random.point(0.12);
    const double size = random.scale(1e-3, 0.05);
    FaceIndices face = {3 * i, 3 * i + 1, 3 * i + 2};
    for (std::uint32_t& corner : face) {
      const Eigen::Vector3f vertex = (center + size * random.direction()).cast<float>();
      add_vertex(soup, {vertex.x(), vertex.y(), vertex.z()});
      const int earlier = static_cast<int>(3 * i) - 1;
      if (i > 0 && random.chance(0.2)) corner = random.integer(0, earlier);
    }
    soup.faces.push_back(face);
  }
  return soup;
}

/// The same surface, whose vertices are moved by up to `by` [m] in each coordinate.
inline GridSurface shaken(GridSurface surface, double by, oracle::Random& random) {
  for (float& x : surface.vertices) x += static_cast<float>(random.uniform(-by, by));
  return surface;
}

/// A closed bumpy surface, about 0.2 m long, with as many faces as the paper's liver: 1224.
inline GridSurface liver() {
  GridSurface ball = sphere(17, 36, 1.0);
  for (std::size_t i = 0; i < ball.vertices.size(); i += 3) {
    Eigen::Map<Eigen::Array3f> at(&ball.vertices[i]);
    const float bump = 1.0F + 0.2F * std::sin(5.0F * at[0]) + 0.1F * std::cos(7.0F * at[2]);
    at *= bump * Eigen::Array3f(0.1F, 0.06F, 0.04F);
  }
  return ball;
}

/// The axis of a tool that has none.
const ShaftAxis kNoShaft{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};

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

/// The same for a shaft and links, which rotate by at most `rotation` [rad] on each leg.
inline ToolPath random_link_path(std::size_t links, double rotation, oracle::Random& random) {
  ToolPath path = random_path(true, random);
  for (std::size_t link = 0; link < links; ++link) {
    Eigen::Isometry3d pose = oracle::random_pose(0.1, random);
    for (ToolWaypoint& waypoint : path) {
      waypoint.links.push_back(pose);
      pose.linear() *= oracle::random_turn(random.scale(1e-5, rotation), random);
      pose.translation() += random.scale(1e-5, 0.05) * random.direction();
    }
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

inline LinkPart random_part(bool may_be_mesh, oracle::Random& random) {
  const Eigen::Isometry3d pose = oracle::random_pose(0.03, random);
  switch (random.integer(0, may_be_mesh ? 3 : 2)) {
    case 0:
      return LinkPart::sphere(pose.translation(), random.scale(3e-3, 0.04));
    case 1:
      return LinkPart::cylinder(pose, random.scale(3e-3, 0.04), random.scale(3e-3, 0.15));
    case 2:
      return LinkPart::box(
          pose, {random.scale(3e-3, 0.15), random.scale(3e-3, 0.15), random.scale(3e-3, 0.15)});
    default:
      return LinkPart::mesh(
          scattered_mesh(static_cast<std::size_t>(random.integer(1, 20)), random).surface());
  }
}

inline std::vector<Link> random_links(bool may_be_meshes, oracle::Random& random) {
  std::vector<Link> links(static_cast<std::size_t>(random.integer(1, 3)));
  for (Link& link : links) {
    link.name = "link " + std::to_string(&link - links.data());
    const int parts = random.integer(1, 3);
    for (int i = 0; i < parts; ++i) link.parts.push_back(random_part(may_be_meshes, random));
  }
  return links;
}

/// An organ that rests or moves, and a tool that has links, with or without a shaft.
struct LinkScene {
  LinkScene(bool may_be_meshes, oracle::Random& random, double rotation = 0.19)
      : soup(scattered_faces(150, random)),
        organ(mesh(soup)),
        before(mesh(shaken(soup, random.scale(1e-5, 0.02), random))),
        links(random_links(may_be_meshes, random)) {
    request = swept(organ, random_link_path(links.size(), rotation, random), 0.0);
    if (random.chance(0.5)) request.radius = random.scale(0.5e-3, 0.01);
    if (random.chance(0.5)) request.organ_before = &before;
    request.links = &links;
  }
  LinkScene(const LinkScene&) = delete;
  LinkScene& operator=(const LinkScene&) = delete;

  /// The tool has no shaft.
  void remove_shaft() { request.radius = 0.0; }
  /// The tool has no links.
  void remove_links(oracle::Random& random) {
    request.links = nullptr;
    for (ToolWaypoint& waypoint : request.path) waypoint.links.clear();
    request.radius = random.scale(0.5e-3, 0.01);
  }

  GridSurface soup;
  TriangleMesh organ, before;
  std::vector<Link> links;
  CollisionRequest request;
};

/// [m] At rest, distances agree to this.
constexpr double kExact = 1e-9;
/// [m] While something moves, both the search and the measurement may be this much too large.
constexpr double kMoving = 2.0 * tolerance::kApproach;

/// [m] The distance of each face from the tool at the end of the step, by the oracle.
inline std::vector<double> distances_at_end(const CollisionRequest& request) {
  static const std::vector<Link> none;
  const auto cores = oracle::placed_cores(request.radius, request.links ? *request.links : none,
                                          {request.path.back().axis, request.path.back().links});
  std::vector<double> distances;
  for (std::uint32_t face = 0; face < request.organ->face_count(); ++face) {
    double least = std::numeric_limits<double>::infinity();
    for (const oracle::PlacedCore& part : cores) {
      const double distance = oracle::rounded_distance(part.core, request.organ->triangle(face));
      least = std::min(least, distance - part.radius);
    }
    distances.push_back(least);
  }
  return distances;
}

inline void expect_same(const FaceContact& a, const FaceContact& b, double slack) {
  EXPECT_EQ(a.face, b.face);
  EXPECT_EQ(a.link, b.link);
  EXPECT_NEAR(a.fraction, b.fraction, slack);
  EXPECT_LE((a.point - b.point).norm(), slack) << "face " << a.face;
  EXPECT_LE((a.normal - b.normal).norm(), slack) << "face " << a.face;
  EXPECT_LE((a.barycentric - b.barycentric).norm(), slack) << "face " << a.face;
  EXPECT_NEAR(a.shaft, b.shaft, slack);
  EXPECT_NEAR(a.depth, b.depth, slack);
  EXPECT_EQ(a.behind, b.behind);
  EXPECT_LE((a.on_organ - b.on_organ).norm(), slack) << "face " << a.face;
  EXPECT_EQ(a.touching, b.touching) << "face " << a.face;
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
