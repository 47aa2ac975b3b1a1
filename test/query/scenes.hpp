#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "geometry/distance/first_touch.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "query/moving_part.hpp"
#include "test/closed_surfaces.hpp"
#include "test/geometry/tool/tool_meshes.hpp"

/// Organs and tools for the tests of queries, and answers by brute force: of every face with every
/// part on every leg, without picking, boxes or bounds.
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

/// How an organ changes during a step.
enum class Change { kNone, kShakes, kGlitches, kJumps };

/// The organ's shape at the start of the step.
inline GridSurface changed(const GridSurface& soup, Change change, oracle::Random& random) {
  if (change == Change::kShakes) return shaken(soup, random.scale(1e-5, 0.02), random);
  GridSurface before = soup;
  const double size = random.scale(0.02, 0.2);
  if (change == Change::kGlitches) {
    for (int i = 0; i < 3; ++i) {
      const auto last = static_cast<int>(soup.vertices.size()) - 1;
      before.vertices[static_cast<std::size_t>(random.integer(0, last))] +=
          static_cast<float>(random.chance(0.3) ? 1e5 : size);
    }
  }
  if (change == Change::kJumps) {
    const Eigen::Vector3f jump = (size * random.direction()).cast<float>();
    before = moved(before, {jump.x(), jump.y(), jump.z()});
  }
  return before;
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

/// A path of `legs` legs from the start of `smooth` to its end. Each waypoint is displaced by up to
/// `tremor` [m], and each link also rotated by up to as many radians.
inline ToolPath trembling(const ToolPath& smooth, int legs, double tremor, oracle::Random& random) {
  ToolPath path;
  const ToolWaypoint &from = smooth.front(), &to = smooth.back();
  for (int i = 0; i <= legs; ++i) {
    const double time = static_cast<double>(i) / legs;
    ToolWaypoint waypoint{time, ShaftMotion{from.axis, to.axis}.at(time)};
    waypoint.axis.tip += tremor * random.direction();
    if (random.chance(0.5)) waypoint.axis.trocar += tremor * random.direction();
    for (std::size_t link = 0; link < from.links.size(); ++link) {
      Eigen::Isometry3d pose = RigidMotion(from.links[link], to.links[link]).at(time);
      pose.translation() += tremor * random.direction();
      pose.linear() *= oracle::random_turn(tremor, random);
      waypoint.links.push_back(pose);
    }
    path.push_back(waypoint);
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

/// A face on one leg of a step, and where it is at the end of the whole step.
struct FaceLeg {
  FaceMotion motion;
  double begin, finish;  ///< fractions of the step at which the leg begins and ends
  Triangle end;          ///< the face at the end of the step
};

/// Calls use(face, shape, part, face_leg) for each face, each part of the tool and each leg.
/// `shape` is null for the shaft.
template <typename Use>
void for_each_pair(const CollisionRequest& request, const Use& use) {
  const bool is_static = request.mode == QueryMode::kStatic;
  const ToolPath path = is_static ? ToolPath{request.path.back()} : request.path;
  const auto on_faces = [&](const LinkPart* shape, const MovingPart& part, double begin,
                            double finish) {
    for (std::uint32_t face = 0; face < request.organ->face_count(); ++face) {
      const Triangle after = request.organ->triangle(face);
      const bool rests = is_static || !request.organ_before;
      const FaceMotion whole{rests ? after : request.organ_before->triangle(face), after};
      const FaceLeg leg{{whole.at(begin), whole.at(finish)}, begin, finish, after};
      use(face, shape, part, leg);
    }
  };
  for (std::size_t leg = 0; leg < std::max<std::size_t>(path.size() - 1, 1); ++leg) {
    const bool rests = path.size() == 1;
    const ToolWaypoint &from = path[leg], &to = path[rests ? leg : leg + 1], &last = path.back();
    const double begin = rests ? 0.0 : from.fraction, finish = rests ? 1.0 : to.fraction;
    const bool has_shaft = request.radius > 0.0;
    if (has_shaft) {
      const ShaftMotion shaft{from.axis, to.axis};
      on_faces(nullptr, MovingShaft(shaft, request.radius, last.axis), begin, finish);
    }
    for (std::size_t i = 0; request.links && i < request.links->size(); ++i) {
      const Link& link = (*request.links)[i];
      const RigidMotion motion(from.links[i], to.links[i]);
      for (const LinkPart& part : link.parts) {
        const auto number = static_cast<std::int32_t>(i);
        const MovingLinkPart moving(part, link, number, motion, last.links[i]);
        on_faces(&part, moving, begin, finish);
      }
    }
  }
}

/// The contact of one part and one face by exact distances, without a work limit.
inline std::optional<FaceContact> contact_of(const std::optional<FirstTouch>& touch,
                                             const MovingPart& part, const FaceLeg& face) {
  if (!touch) return std::nullopt;
  FaceContact contact = part.contact(*touch, face.motion, face.end);
  contact.fraction = face.begin + touch->time * (face.finish - face.begin);
  return contact;
}
inline std::optional<FaceContact> refine(const MovingPart& part, const FaceLeg& face) {
  return contact_of(first_touch(part.core(), face.motion, part.radius()), part, face);
}

/// The contact of a face with the triangle of a part's surface that touches it first.
inline std::optional<FaceContact> refine_surface(const MovingPart& part, const ToolSurface& surface,
                                                 const FaceLeg& face) {
  std::optional<FirstTouch> first;
  for (std::size_t i = 0; i < surface.faces().size(); ++i) {
    const ConvexCore core(surface.triangle(i));
    const auto touch =
        first_touch(CoreMotion(core, *part.core().link()), face.motion, part.radius());
    if (touch && (!first || touch->time < first->time)) first = touch;
  }
  return contact_of(first, part, face);
}

/// The contacts by brute force, sorted by face, then link. The earlier contact is kept, then the
/// deeper one, then the one whose point comes first.
inline std::vector<FaceContact> contacts_by_brute_force(CollisionRequest request) {
  const auto order = [](const FaceContact& c) {
    return std::make_tuple(c.fraction, -c.depth, c.point.x(), c.point.y(), c.point.z());
  };
  std::map<std::pair<std::uint32_t, std::int32_t>, FaceContact> best;
  for_each_pair(request, [&](std::uint32_t face, const LinkPart* shape, const MovingPart& part,
                             const FaceLeg& leg) {
    auto contact =
        shape && shape->surface ? refine_surface(part, *shape->surface, leg) : refine(part, leg);
    if (!contact) return;
    contact->face = face;
    const auto [known, is_new] = best.emplace(std::make_pair(face, part.link()), *contact);
    if (!is_new && order(*contact) < order(known->second)) known->second = *contact;
  });
  const bool is_static = request.mode == QueryMode::kStatic;
  request.mode = QueryMode::kStatic;
  const auto at_end = is_static ? std::vector<FaceContact>() : contacts_by_brute_force(request);
  for (auto& [key, contact] : best) contact.touching = is_static;
  for (const FaceContact& contact : at_end) best.at({contact.face, contact.link}).touching = true;
  std::vector<FaceContact> contacts;
  for (const auto& [key, contact] : best) contacts.push_back(contact);
  return contacts;
}

/// [m] At rest, distances agree to this.
constexpr double kExact = 1e-9;
/// [m] While something moves, both the search and the measurement may be this much too large.
constexpr double kMoving = 2.0 * tolerance::kApproach;

/// The distance of each face from the tool [m] by brute force: the smallest one during the step.
inline std::vector<double> distances_by_brute_force(const CollisionRequest& request) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<double> least(request.organ->face_count(), kInfinity);
  for_each_pair(request, [&](std::uint32_t face, const LinkPart* shape, const MovingPart& part,
                             const FaceLeg& leg) {
    const double radius = shape ? shape->ball_radius() : part.radius();
    const auto measure = [&](const CoreMotion& core) {
      WorkBudget unlimited = WorkBudget::unlimited();
      const auto found = closest_approach(core, leg.motion, kInfinity, unlimited);
      least[face] = std::min(least[face], found->closest.distance - radius);
    };
    if (!shape || !shape->surface) return measure(part.core());
    for (std::size_t i = 0; i < shape->surface->faces().size(); ++i) {
      measure(CoreMotion(ConvexCore(shape->surface->triangle(i)), *part.core().link()));
    }
  });
  return least;
}

inline std::vector<double> distances_at_end(CollisionRequest request) {
  request.mode = QueryMode::kStatic;
  return distances_by_brute_force(request);
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

/// The same faces and links at the same times, where rounding decides which of several touches at
/// the same time is the first.
inline void expect_same_touches(const std::vector<FaceContact>& a,
                                const std::vector<FaceContact>& b, double slack) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].face, b[i].face);
    EXPECT_EQ(a[i].link, b[i].link);
    EXPECT_NEAR(a[i].fraction, b[i].fraction, slack);
  }
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
