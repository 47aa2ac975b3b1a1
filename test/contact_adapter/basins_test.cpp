#include "contact_adapter/basins.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "force_trajectory.hpp"

using namespace organ_collision;
using Eigen::Vector3d;

namespace {

std::vector<Contact> contacts_of(const TriangleMesh& organ, const ShaftAxis& axis) {
  CollisionRequest request;
  request.organ = &organ;
  request.radius = kRadius;
  request.path = {{0.0, axis}};
  CollisionQuery query;
  CollisionResult result;
  query.evaluate(request, result);
  std::vector<Contact> contacts;
  for (const FaceContact& contact : result.contacts) contacts.push_back(to_message(contact));
  return contacts;
}

/// The distinct normals, rounded to 1e-6, of the contacts that are local minima.
std::set<std::vector<long>> nearest_normals(const std::vector<Contact>& contacts) {
  const std::vector<std::size_t> basins = basins_of(contacts);
  std::set<std::vector<long>> normals;
  for (const std::size_t i : basins) {
    EXPECT_EQ(basins[i], i);
    const auto& n = contacts[i].normal;
    normals.insert({std::lround(1e6 * n.x), std::lround(1e6 * n.y), std::lround(1e6 * n.z)});
  }
  return normals;
}

}  // namespace

TEST(Basins, OfFlatTissueTheNearestIsOneHoweverItIsDivided) {
  for (const double height : {0.0049, 0.003, 0.001, 1e-5}) {
    const Vector3d tip(0.0017, 0.0023, height);
    for (const double cell : {0.02, 0.005, 0.00125}) {
      const auto contacts =
          contacts_of(folded_sheet(0.0, 0.0, cell), {tip + Vector3d(0.01, 0.02, 0.1), tip});
      EXPECT_EQ(nearest_normals(contacts), (std::set<std::vector<long>>{{0, 0, -1000000}}));
    }
  }
}

TEST(Basins, OfACreaseBothSidesAreNearest) {
  // The axis is 1 mm from one wall and 4.2 mm from the other.
  const double across = std::sqrt(0.5) * (0.001 - 0.0042), up = std::sqrt(0.5) * 0.0052;
  for (const double cell : {0.02, 0.0025, 0.00125}) {
    const auto contacts = contacts_of(folded_sheet(M_PI / 4, M_PI / 4, cell),
                                      {{across, -0.05, up}, {across, 0.0431, up}});
    EXPECT_EQ(nearest_normals(contacts),
              (std::set<std::vector<long>>{{-707107, 0, -707107}, {707107, 0, -707107}}));
  }
}

TEST(Basins, AContactThatNothingIsKnownOfIsItsOwn) {
  const std::vector<Contact> contacts(3, contact({0.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, 0.001));
  EXPECT_EQ(basins_of(contacts), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_TRUE(basins_of({}).empty());
}

TEST(Basins, OtherLinksDoNotCount) {
  Contact far = contact({0.001, 0.0, 0.0}, {0.5, 0.0, -1.0}, 0.001), near = far;
  far.vertices = {1, 2, 3};
  far.barycentric = {1.0, 0.0, 0.0};
  near.vertices = {1, 4, 5};
  near.point.x = 0.0;
  near.barycentric = {0.2, 0.4, 0.4};
  EXPECT_EQ(basins_of({far, near}), (std::vector<std::size_t>{1, 1}));
  near.link = 1;
  EXPECT_EQ(basins_of({far, near}), (std::vector<std::size_t>{0, 1}));
}

TEST(Basins, AWayThatLeadsBackEnds) {
  // From the point of each face, the other one seems nearer. This may happen if the faces were
  // first touched at different times.
  Contact a = contact({0.001, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.001), b = a;
  a.vertices = {1, 2, 3};
  b.vertices = {1, 2, 4};
  a.barycentric = {1.0, 0.0, 0.0};
  b.barycentric = {0.0, 1.0, 0.0};
  b.point.x = 0.0;
  b.normal.x = -1.0;
  const std::vector<std::size_t> basins = basins_of({a, b});
  EXPECT_EQ(basins[0], basins[1]);
  EXPECT_EQ(basins[basins[0]], basins[0]);
}
