#include "contact_adapter/force_law.hpp"

#include <gtest/gtest.h>

#include "force_trajectory.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

constexpr double kSeconds = 0.001;  // [s]

/// Follows an answer whose contacts push with their own normals and depths.
std::optional<double> follow(ContactMotion& motion, const std::vector<Contact>& contacts,
                             const ShaftRadius& radius = kRadius) {
  std::vector<Push> pushes;
  for (const Contact& c : contacts) {
    pushes.push_back({to_eigen(c.on_organ), to_eigen(c.normal), c.depth, true});
  }
  return motion.follow(touched(contacts), pushes, radius);
}

Contact of_depth(double depth, const Vector3d& normal = {0.0, 0.0, -1.0}, double fraction = 0.0) {
  Contact at = contact({0.1, 0.2, 0.3}, normal, depth);
  at.fraction = fraction;
  return at;
}

TEST(ContactMotion, IsTheGreatestBoundThatAFaceGives) {
  const Vector3d down(0.0, 0.0, -1.0), turned(std::sin(0.1), 0.0, -std::cos(0.1));
  const Vector3d tilted(0.0, 0.01, -1.0);
  struct {
    const char* name;
    ShaftRadius radius;
    std::vector<Contact> before, now;
    double way;  ///< [m]
  } const rows[] = {
      {"the depth grows", kRadius, {of_depth(0.001)}, {of_depth(0.0015)}, 0.0005},
      {"the depth shrinks", kRadius, {of_depth(0.0015)}, {of_depth(0.0008)}, 0.0007},
      {"nothing changes", kRadius, {of_depth(0.0008)}, {of_depth(0.0008)}, 0.0},
      {"a new face", kRadius, {}, {of_depth(0.001)}, 0.001},
      {"a face that is left", kRadius, {of_depth(0.001)}, {}, 0.001},
      {"a stab", kRadius, {}, {of_depth(0.06, down, 0.5)}, 0.06},
      {"deeper", kRadius, {of_depth(0.06, down, 0.5)}, {of_depth(0.063)}, 0.003},
      {"the axis came to lie in the face",
       kRadius,
       {of_depth(kRadius - 0.0001)},
       {of_depth(0.06)},
       0.0001},
      {"a face that was passed and is left", kRadius, {of_depth(0.06)}, {}, 0.0},
      // The normal turns about an edge that is 3 mm away, and half of the way counts.
      {"the normal turns",
       kRadius,
       {of_depth(0.002, down)},
       {of_depth(0.002, turned)},
       0.003 * std::sin(0.05)},
      {"a link: the depth", {}, {of_depth(0.002, down)}, {of_depth(0.003, tilted)}, 0.001},
      {"a link: another side", {}, {of_depth(0.003, tilted)}, {of_depth(0.0028, -tilted)}, 0.0},
      // The normal and the depth of the whole link replace those of the first touch.
      {"a link that is pierced from the side",
       {},
       {of_depth(0.0001, Vector3d::UnitX())},
       {of_depth(0.02, down)},
       0.0},
      {"a link that leaves", {}, {of_depth(0.02, down)}, {}, 0.0},
      {"a link that is pierced at once", {}, {}, {of_depth(0.02, down)}, 0.0},
      {"a link that touches now", {}, {}, {of_depth(0.0003, down, 0.4)}, 0.0003},
      {"after its first touch", {}, {of_depth(0.0003, down, 0.4)}, {of_depth(0.001, tilted)}, 0.0},
  };
  for (const auto& row : rows) {
    ContactMotion motion;
    EXPECT_FALSE(follow(motion, row.before, row.radius)) << row.name;
    EXPECT_NEAR(follow(motion, row.now, row.radius).value(), row.way, 1e-12) << row.name;
  }
}

TEST(ContactMotion, WherePushesAreOfTheSideTheTipsDepthIsNoWay) {
  const Push side{{0.1, 0.2, 0.3}, {0.0, 0.0, -1.0}, kRadius, true};
  ContactMotion lying;
  lying.follow(touched({of_depth(0.06)}), {side}, kRadius);
  EXPECT_EQ(lying.follow(touched({of_depth(0.07)}), {side}, kRadius).value(), 0.0);
}

TEST(ContactMotion, AKnownClearanceThatChangesIsAWay) {
  ContactArray answer = touched({});
  ContactMotion motion;
  const auto way = [&](std::uint8_t state, double distance, bool unresolved = false) {
    answer.clearance.state = state;
    answer.clearance.distance = distance;
    answer.clearance.unresolved = unresolved;
    return motion.follow(answer, {}, kRadius).value_or(-1.0);
  };
  EXPECT_EQ(way(Clearance::KNOWN, 0.02), -1.0);
  EXPECT_NEAR(way(Clearance::KNOWN, 0.0207), 0.0007, 1e-12);
  EXPECT_NEAR(way(Clearance::KNOWN, 0.0198), 0.0009, 1e-12);
  EXPECT_EQ(way(Clearance::KNOWN, 0.5, true), 0.0);
  EXPECT_EQ(way(Clearance::BEYOND_MARGIN, 0.5), 0.0);
}

/// An answer about a floor and a wall. If the wall is hidden, its push does not count: its nearest
/// corner also belongs to the floor, which is nearer to the tool.
ContactArray floor_and_wall(double floor_depth, double wall_depth, bool is_hidden = false) {
  Contact floor = contact({0.09, 0.0, 0.0}, {0.0, 0.0, -1.0}, floor_depth);
  floor.vertices = {0, 1, 2};
  Contact wall = contact({0.1, 0.0, 0.3}, {1.0, 0.0, 0.0}, wall_depth);
  wall.face = 1;
  wall.vertices = {3, 4, 5};
  wall.on_organ = wall.point;
  if (is_hidden) {
    wall.vertices[0] = 2;
    wall.barycentric = {1.0, 0.0, 0.0};
  }
  return touched({floor, wall});
}

Vector3d force(ForceLaw& law, const ContactArray& answer, double seconds = kSeconds) {
  return sum_of(law.follow(answer, seconds, kStiffness, kRadius));
}

void expect_near(const Vector3d& found, const Vector3d& expected) {
  EXPECT_LE((found - expected).norm(), 1e-9)
      << found.transpose() << " instead of " << expected.transpose();
}

const Vector3d kUp(0.0, 0.0, 0.003 * kStiffness), kLeft(-0.002 * kStiffness, 0.0, 0.0);

TEST(ForceLaw, ADepthThatGrowsIsFollowedAtOnceAndItsEndToo) {
  ForceLaw law;
  force(law, touched({}));
  for (const double depth : {0.0001, 0.002, 0.003, 0.0005}) {
    expect_near(force(law, touched({of_depth(depth)}), 0.0), {0.0, 0.0, kStiffness * depth});
  }
  expect_near(force(law, touched({}), 0.0), Vector3d::Zero());
}

TEST(ForceLaw, ASpringThatAppearsIsFollowedByTheWayAndTheTime) {
  ForceLaw law;
  expect_near(force(law, floor_and_wall(0.003, 0.002, true)), kUp);
  for (int step = 1; step <= 40; ++step) {
    // While the tool rests, the force changes by stiffness * 0.05 mm each millisecond.
    const double share = std::min(1.0, 0.025 * step);
    expect_near(force(law, floor_and_wall(0.003, 0.002)), kUp + share * kLeft);
  }
  expect_near(force(law, floor_and_wall(0.003, 0.002, true), 0.0), kUp + kLeft);
  const Vector3d moved = force(law, floor_and_wall(0.0031, 0.002, true), 0.0);
  const Vector3d back = Vector3d(0.0, 0.0, 0.0031 * kStiffness) - (kUp + kLeft);
  expect_near(moved, kUp + kLeft + 4.0 * kStiffness * 0.0001 * back.normalized());
}

TEST(ForceLaw, EachForceIsAtThePointOfItsContactAtTheEndOfTheStep) {
  ContactArray answer = floor_and_wall(0.003, 0.002);
  answer.contacts[0].on_organ.y = 0.07;
  answer.contacts[1].barycentric = {0.2, 0.3, 0.5};
  const std::vector<FaceForce> forces = ForceLaw().follow(answer, 0.0, kStiffness, kRadius);
  ASSERT_EQ(forces.size(), 2U);
  EXPECT_EQ(forces[0].place, Vector3d(0.0, 0.07, 0.0));
  EXPECT_EQ(forces[1].place, Vector3d(0.1, 0.0, 0.3));
  EXPECT_EQ(forces[1].face, 1U);
  EXPECT_EQ(forces[1].vertices, (FaceIndices{3, 4, 5}));
  EXPECT_EQ(forces[1].barycentric, Vector3d(0.2, 0.3, 0.5));
}

TEST(ForceLaw, AStaticAnswerAndAnotherTopologyBeginAnew) {
  ForceLaw law;
  force(law, floor_and_wall(0.003, 0.002, true));
  ContactArray appeared = floor_and_wall(0.003, 0.002);
  appeared.topology = 1;
  expect_near(force(law, appeared, 0.0), kUp + kLeft);
  ContactArray hidden = floor_and_wall(0.003, 0.002, true);
  hidden.mode = ContactArray::STATIC;
  expect_near(force(law, hidden, 0.0), kUp);
  // The side on which the tool first touched a face is forgotten, too.
  ContactArray past = touched({of_depth(0.004, Vector3d::UnitZ())});
  past.contacts[0].behind = true;
  force(law, touched({of_depth(0.004)}));
  EXPECT_GT(force(law, past, 1.0).z(), 0.0);
  past.mode = ContactArray::STATIC;
  expect_near(force(law, past), {0.0, 0.0, -0.004 * kStiffness});
}

}  // namespace
}  // namespace organ_collision
