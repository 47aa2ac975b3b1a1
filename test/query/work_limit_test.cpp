// collision_query.hpp for requests that need more work than a query may cost.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenes.hpp"
#include "test/proof/link_trials.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using oracle::Random;

constexpr double kFar = 4e5;  // [m]

/// Long thin faces that intersect each other.
GridSurface slivers(std::uint32_t count, Random& random) {
  GridSurface soup;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vector3d a = random.point(kFar), b = random.point(kFar);
    const Vector3d c =
        a + random.uniform(-0.2, 1.2) * (b - a) + random.scale(1e-3, 1e3) * random.direction();
    for (const Vector3d& corner : {a, b, c}) {
      for (int k = 0; k < 3; ++k) soup.vertices.push_back(static_cast<float>(corner[k]));
    }
    soup.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return soup;
}

/// A tool that rotates and moves among long thin faces that move as well.
class WorkLimit : public testing::Test {
 protected:
  WorkLimit() {
    request_ = swept(organ_, {}, 0.0);
    request_.organ_before = &before_;
    const Isometry3d start = oracle::random_pose(0.3 * kFar, random_);
    Isometry3d end = start;
    end.linear() *= oracle::random_turn(0.19, random_);
    end.translation() += 0.5 * kFar * random_.direction();
    for (const Isometry3d& pose : {start, end}) {
      request_.path.push_back({pose.isApprox(start) ? 0.0 : 1.0,
                               {pose * Vector3d(0.0, 0.0, kFar), pose * Vector3d(kFar, 0.0, -kFar)},
                               {pose}});
    }
  }

  std::vector<FaceContact> contacts() {
    query_.evaluate(request_, result_);
    return result_.contacts;
  }

  Random random_{1};
  const GridSurface soup_ = slivers(60'000, random_);
  const TriangleMesh organ_ = mesh(soup_), before_ = mesh(shaken(soup_, 0.3 * kFar, random_));
  CollisionRequest request_;
  CollisionQuery query_;
  CollisionResult result_;
};

/// Expects every face that touches, found without a limit to the work, among the contacts.
void expect_none_missed(const MovingPart& part, const CollisionRequest& request,
                        const CollisionResult& result) {
  auto contact = result.contacts.begin();
  std::size_t resolved = 0;
  for (std::uint32_t face = 0; face < request.organ->face_count(); face += 7) {
    const Triangle end = request.organ->triangle(face);
    const auto touch =
        first_touch(part.core(), {request.organ_before->triangle(face), end}, part.radius());
    contact = std::lower_bound(contact, result.contacts.end(), face,
                               [](const FaceContact& c, std::uint32_t f) { return c.face < f; });
    const bool is_found = contact != result.contacts.end() && contact->face == face;
    if (touch) {
      ASSERT_TRUE(is_found) << "face " << face;
    }
    if (is_found && contact->is_resolved) {
      ++resolved;
      ASSERT_TRUE(touch);
      EXPECT_EQ(contact->fraction, touch->time);
    }
  }
  EXPECT_GT(resolved, 10U);
}

void expect_counted(const CollisionResult& result) {
  for (const FaceContact& contact : result.contacts) {
    EXPECT_TRUE(contact.point.allFinite());
    EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-9);
    EXPECT_TRUE(std::isfinite(contact.depth));
    EXPECT_GE(contact.fraction, 0.0);
    EXPECT_LE(contact.fraction, 1.0);
  }
  const auto unresolved = std::count_if(result.contacts.begin(), result.contacts.end(),
                                        [](const FaceContact& c) { return !c.is_resolved; });
  EXPECT_EQ(result.unresolved, static_cast<std::size_t>(unresolved));
  EXPECT_GT(unresolved, 0);
}

TEST_F(WorkLimit, OfLinksReportsWhatIsNotResolved) {
  for (const LinkPart& part :
       {LinkPart::box(Isometry3d::Identity(), {kFar, 1e-6 * kFar, 0.01 * kFar}),
        LinkPart::cylinder(Isometry3d::Identity(), 0.3 * kFar, 0.1 * kFar)}) {
    const std::vector<Link> links = {{"link", {part}}};
    request_.links = &links;
    contacts();
    expect_counted(result_);
    const RigidMotion motion(request_.path[0].links[0], request_.path[1].links[0]);
    expect_none_missed(MovingLinkPart(part, links[0], 0, motion, motion.end()), request_, result_);
  }
}

/// The contacts of a link, 0.3 m long, that turns by an angle [rad] through a finely meshed organ.
CollisionResult through_tissue(const LinkPart& part, double angle) {
  const GridSurface sheet = grid_surface(80);
  const TriangleMesh organ(sheet.vertices, sheet.triangles());
  const std::vector<Link> links = {{"link", {part}}};
  CollisionRequest request = swept(organ, {}, 0.0);
  request.links = &links;
  Isometry3d start = Isometry3d::Identity();
  start.translate(Vector3d(0.01, -0.02, 0.024));
  start.rotate(Eigen::AngleAxisd(1.52, Vector3d(0.1, 1.0, 0.05).normalized()));
  Isometry3d end = start;
  end.translation() += Vector3d(-0.01, 0.01, -0.012);
  end.linear() = Eigen::AngleAxisd(angle, Vector3d(0.03, 0.04, 1.0).normalized()) * end.linear();
  request.path = {{0.0, {}, {start}}, {1.0, {}, {end}}};
  CollisionQuery query;
  CollisionResult result;
  query.evaluate(request, result);
  return result;
}

// Ordinary scenes: a tool turns in the plane of the tissue, by up to half a turn.
TEST(WorkLimitOfOrdinaryScenes, IsNotReached) {
  const Isometry3d pose = Isometry3d::Identity();
  for (const double angle : {0.4, 0.6, 1.5, 3.0}) {
    for (const LinkPart& part :
         {LinkPart::cylinder(pose, 0.005, 0.3), LinkPart::box(pose, {0.01, 0.01, 0.3})}) {
      const CollisionResult result = through_tissue(part, angle);
      EXPECT_GT(result.contacts.size(), 400U);
      EXPECT_EQ(result.unresolved, 0U) << "angle " << angle;
    }
  }
}

}  // namespace
}  // namespace organ_collision
