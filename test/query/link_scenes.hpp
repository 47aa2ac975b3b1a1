#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "organ_collision/query/collision_query.hpp"
#include "query/contact_refiner.hpp"
#include "scenes.hpp"
#include "test/geometry/tool/tool_meshes.hpp"

namespace organ_collision {

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

}  // namespace organ_collision
