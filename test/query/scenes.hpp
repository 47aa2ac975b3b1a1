#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "geometry/distance/closest_approach.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "query/contact_refiner.hpp"
#include "test/geometry/tool/tool_meshes.hpp"
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

/// A path of shaft and links, of one to three legs. On each leg, links rotate by at most `rotation`
/// [rad].
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

  Soup soup;
  TriangleMesh organ, before;
  std::vector<Link> links;
  CollisionRequest request;
};

/// The contact of a face with the triangle of a part's surface that touches it first.
inline std::optional<FaceContact> refine_surface(const PartLeg& part, const ToolSurface& surface,
                                                 const FaceLeg& face) {
  std::optional<FirstTouch> first;
  for (std::size_t i = 0; i < surface.faces().size(); ++i) {
    const ConvexCore core(surface.triangle(i));
    const auto touch = first_touch(CoreMotion(core, *part.core.link()), face.motion, part.radius);
    if (touch && (!first || touch->time < first->time)) first = touch;
  }
  if (!first) return std::nullopt;
  return contact_of(*first, part, face);
}

/// The contacts of every face with every part on every leg, without picking or boxes.
class BruteForce {
 public:
  explicit BruteForce(const CollisionRequest& request) : request_(request) {
    const bool has_shaft = request.radius > 0.0;
    for (std::uint32_t face = 0; face < request.organ->face_count(); ++face) {
      if (has_shaft) touch_shaft(face);
      for (std::uint32_t link = 0; request.links && link < request.links->size(); ++link) {
        touch_link(face, link, has_shaft ? link + 1 : link);
      }
    }
  }

  const std::vector<FaceContact>& contacts() const { return contacts_; }

 private:
  FaceLeg leg(std::uint32_t face, std::size_t i) const {
    const Triangle after = request_.organ->triangle(face);
    const FaceMotion whole{request_.organ_before ? request_.organ_before->triangle(face) : after,
                           after};
    const double begin = request_.path[i - 1].fraction, finish = request_.path[i].fraction;
    return {{whole.at(begin), whole.at(finish)}, begin, finish, after};
  }

  void touch_shaft(std::uint32_t face) {
    std::optional<FaceContact> best;
    for (std::size_t i = 1; i < request_.path.size(); ++i) {
      const ShaftMotion shaft{request_.path[i - 1].axis, request_.path[i].axis};
      keep_first(refine({shaft, request_.radius, {request_.path.back().axis}}, leg(face, i)), best);
    }
    keep(best, face);
  }

  void touch_link(std::uint32_t face, std::uint32_t index, std::uint32_t number) {
    const Link& link = (*request_.links)[index];
    std::optional<FaceContact> best;
    for (std::size_t i = 1; i < request_.path.size(); ++i) {
      const RigidMotion motion(request_.path[i - 1].links[index], request_.path[i].links[index]);
      for (const LinkPart& part : link.parts) {
        const PartLeg on_leg{{part.core, motion},
                             part.radius,
                             {{}, &link, request_.path.back().links[index]},
                             number};
        keep_first(part.surface ? refine_surface(on_leg, *part.surface, leg(face, i))
                                : refine(on_leg, leg(face, i)),
                   best);
      }
    }
    keep(best, face);
  }

  static void keep_first(const std::optional<FaceContact>& contact,
                         std::optional<FaceContact>& best) {
    if (contact && (!best || is_before(*contact, *best))) best = contact;
  }

  /// Whether `a` is the contact to keep. The earlier contact is kept, then the deeper one, then the
  /// one whose point comes first.
  static bool is_before(const FaceContact& a, const FaceContact& b) {
    const Eigen::Vector3d &p = a.point, &q = b.point;
    return std::make_tuple(a.fraction, -a.depth, p.x(), p.y(), p.z()) <
           std::make_tuple(b.fraction, -b.depth, q.x(), q.y(), q.z());
  }

  void keep(const std::optional<FaceContact>& best, std::uint32_t face) {
    if (!best) return;
    contacts_.push_back(*best);
    contacts_.back().face = face;
  }

  const CollisionRequest& request_;
  std::vector<FaceContact> contacts_;
};

inline void expect_same_links(const std::vector<FaceContact>& a,
                              const std::vector<FaceContact>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].link, b[i].link);
}

/// [m] At rest, distances agree to this.
constexpr double kExact = 1e-9;
/// [m] While something moves, both the search and the measurement may be this much too large.
constexpr double kMoving = 2.0 * tolerance::kApproach;

/// How near each face comes to a tool, by measuring every face with every convex part on every leg,
/// without boxes and bounds.
class MeasuredApproaches {
 public:
  /// [m] The distance of a face from one link, and where and when it occurs.
  struct Least {
    double distance = std::numeric_limits<double>::infinity();
    std::uint32_t link = 0;
    double fraction = 0.0;
  };

  /// `at_end`: the distances at the end of the step, not the smallest ones during it.
  MeasuredApproaches(const CollisionRequest& request, bool at_end)
      : request_(request), at_end_(at_end), least_(request.organ->face_count()) {
    const bool has_shaft = request.radius > 0.0;
    for (std::uint32_t face = 0; face < least_.size(); ++face) {
      const std::size_t legs = at_end ? 1 : std::max<std::size_t>(request.path.size() - 1, 1);
      for (std::size_t leg = 0; leg < legs; ++leg) {
        if (has_shaft) measure_shaft(face, leg);
        for (std::uint32_t link = 0; request.links && link < request.links->size(); ++link) {
          for (const LinkPart& part : (*request.links)[link].parts) {
            measure_part(face, leg, link, part, has_shaft ? link + 1 : link);
          }
        }
      }
    }
  }

  /// By face.
  const std::vector<Least>& least() const { return least_; }
  Least nearest() const {
    return *std::min_element(least_.begin(), least_.end(), [](const Least& a, const Least& b) {
      return a.distance < b.distance;
    });
  }

 private:
  const ToolWaypoint& from(std::size_t leg) const {
    return at_end_ ? request_.path.back() : request_.path[leg];
  }
  const ToolWaypoint& to(std::size_t leg) const {
    return at_end_ ? request_.path.back()
                   : request_.path[std::min(leg + 1, request_.path.size() - 1)];
  }
  FaceMotion face_motion(std::uint32_t face, std::size_t leg) const {
    const Triangle after = request_.organ->triangle(face);
    if (at_end_ || !request_.organ_before) return {after, after};
    const FaceMotion whole{request_.organ_before->triangle(face), after};
    if (request_.path.size() == 1) return whole;
    return {whole.at(from(leg).fraction), whole.at(to(leg).fraction)};
  }

  void measure_shaft(std::uint32_t face, std::size_t leg) {
    measure(face, leg, CoreMotion(ShaftMotion{from(leg).axis, to(leg).axis}), request_.radius, 0);
  }
  void measure_part(std::uint32_t face, std::size_t leg, std::uint32_t link, const LinkPart& part,
                    std::uint32_t number) {
    const RigidMotion motion(from(leg).links[link], to(leg).links[link]);
    if (!part.surface) {
      return measure(face, leg, CoreMotion(part.core, motion), part.ball_radius(), number);
    }
    for (std::size_t i = 0; i < part.surface->faces().size(); ++i) {
      measure(face, leg, CoreMotion(ConvexCore(part.surface->triangle(i)), motion), 0.0, number);
    }
  }
  void measure(std::uint32_t face, std::size_t leg, const CoreMotion& core, double radius,
               std::uint32_t link) {
    WorkBudget unlimited = WorkBudget::unlimited();
    const auto found = closest_approach(core, face_motion(face, leg),
                                        std::numeric_limits<double>::infinity(), unlimited);
    const double distance = found->closest.distance - radius;
    if (distance >= least_[face].distance) return;
    const double begin = from(leg).fraction, finish = to(leg).fraction;
    least_[face] = {distance, link, begin + found->time * (finish - begin)};
  }

  const CollisionRequest& request_;
  bool at_end_;
  std::vector<Least> least_;
};

}  // namespace organ_collision
