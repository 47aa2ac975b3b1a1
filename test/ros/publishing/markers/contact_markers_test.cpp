#include "ros/publishing/markers/contact_markers.hpp"

#include <gtest/gtest.h>

#include "test/ros/publishing/markers/hand_made_scenes.hpp"

using namespace organ_collision;
using visualization_msgs::Marker;

namespace {

using Add = void (*)(const SceneOrgan&, const ContactArray&, double, MarkerSheet&);

std::vector<Marker> markers(Add add, const ContactArray& answer, double share = 1.0) {
  MarkerSheet sheet;
  add(square(), answer, share, sheet);
  return sheet.markers().markers;
}

std::size_t points_of_an_arrow() {
  return markers(add_normals, *answer_with({contact_at(0, 0.1, 0.5, 0.5)})).at(0).points.size();
}

}  // namespace

TEST(Normals, EndAtTheContactFromTheSideOfTheTool) {
  const auto answer = answer_with({contact_at(0, 0.1, 0.25, 0.5)});
  const Marker arrows = markers(add_normals, *answer).at(0);
  EXPECT_EQ(arrows.ns, "normals");
  double lowest = 1.0, highest = -1.0;
  Eigen::Vector3d head = Eigen::Vector3d::Ones();
  for (std::size_t i = 0; i < arrows.points.size(); ++i) {
    if (point(arrows, i).z() < head.z()) head = point(arrows, i);
    lowest = std::min(lowest, point(arrows, i).z());
    highest = std::max(highest, point(arrows, i).z());
  }
  EXPECT_NEAR(lowest, 0.0, 1e-12);
  EXPECT_GT(highest, 0.01);
  EXPECT_TRUE(head.isApprox(Eigen::Vector3d(0.25, 0.5, 0.0), 1e-9)) << head.transpose();
}

TEST(Normals, OnlyTheDeepestContactsHaveArrows) {
  std::vector<Contact> contacts;
  for (std::size_t i = 0; i < kMostArrows + 20; ++i) {
    const bool deep = i % 2 == 0 && i < 2 * kMostArrows;
    contacts.push_back(contact_at(0, deep ? 0.1 : -0.1, deep ? 0.5 : 8.0, 0.0));
  }
  contacts.resize(kMostArrows + 20, contact_at(0, 0.2, 0.5, 0.0));
  const Marker arrows = markers(add_normals, *answer_with(contacts)).at(0);
  EXPECT_EQ(arrows.points.size(), kMostArrows * points_of_an_arrow());
  std::size_t shallow = 0;
  for (const auto& p : arrows.points) shallow += p.x > 4.0;
  EXPECT_EQ(shallow, (kMostArrows - (kMostArrows + 20) / 2) * points_of_an_arrow());
}

TEST(Normals, FadeAndVanishWithoutContacts) {
  const auto answer = answer_with({contact_at(0, 0.1, 0.25, 0.5)});
  EXPECT_NEAR(markers(add_normals, *answer, 0.25).at(0).color.a, 0.25, 1e-6);
  EXPECT_TRUE(markers(add_normals, *answer_with({})).empty());
}

TEST(Names, EachTouchingLinkHasOneAtItsDeepestContact) {
  auto contacts = std::vector<Contact>{contact_at(0, 0.1, 0.1, 0.0), contact_at(1, 0.3, 0.2, 0.0),
                                       contact_at(1, 0.2, 0.3, 0.0)};
  contacts[2].link = 2;
  const auto answer = answer_with(contacts);
  answer->links = {"", "wrist", "jaw"};
  const auto names = markers(add_names, *answer);
  ASSERT_EQ(names.size(), 2u);
  EXPECT_EQ(names[0].type, Marker::TEXT_VIEW_FACING);
  EXPECT_EQ(names[0].text, "hook");  // The shaft has no name of its own.
  EXPECT_DOUBLE_EQ(names[0].pose.position.x, 0.2);
  EXPECT_GT(names[0].pose.position.z, 0.0);
  EXPECT_EQ(names[1].text, "jaw");
  EXPECT_EQ(names[1].id, 1);
}
