#include "snapshot/marker_store.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace organ_collision {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

Marker marker(const std::string& ns, int id, double lifetime_sec = 0.0) {
  Marker marker;
  marker.header.frame_id = "liver";
  marker.header.stamp = ros::Time(3.0);
  marker.ns = ns;
  marker.id = id;
  marker.lifetime = ros::Duration(lifetime_sec);
  return marker;
}

Marker with_action(Marker marker, int action) {
  marker.action = action;
  return marker;
}

MarkerArray array(const std::vector<Marker>& markers) {
  MarkerArray result;
  result.markers = markers;
  return result;
}

std::set<std::string> shown(const MarkerStore& store) {
  std::set<std::string> result;
  for (const auto& [key, entry] : store.entries()) {
    result.insert(key.topic + " " + key.ns + " " + std::to_string(key.id));
  }
  return result;
}

using Names = std::set<std::string>;

TEST(MarkerStore, AddsReplacesAndDeletes) {
  MarkerStore store;
  const ros::Time now(10.0);
  store.apply("a", array({marker("x", 1), marker("x", 2), marker("y", 1)}), now);
  EXPECT_EQ(shown(store), (Names{"a x 1", "a x 2", "a y 1"}));

  Marker changed = marker("x", 2);
  changed.type = Marker::CUBE;
  store.apply("a", array({changed, with_action(marker("y", 1), Marker::DELETE)}), now);
  EXPECT_EQ(shown(store), (Names{"a x 1", "a x 2"}));
  EXPECT_EQ(store.entries().at({"a", "x", 2}).marker.type, Marker::CUBE);
}

TEST(MarkerStore, TopicsAreSeparate) {
  MarkerStore store;
  store.apply("a", array({marker("x", 1)}), ros::Time(10.0));
  store.apply("b", array({marker("x", 1), marker("x", 2)}), ros::Time(10.0));
  EXPECT_EQ(shown(store), (Names{"a x 1", "b x 1", "b x 2"}));
  store.apply("b", array({with_action(marker("", 0), Marker::DELETEALL), marker("z", 5)}),
              ros::Time(10.0));
  EXPECT_EQ(shown(store), (Names{"a x 1", "b z 5"}));
}

TEST(MarkerStore, KeepsLifetimes) {
  MarkerStore store;
  store.apply("a", array({marker("short", 0, 0.5), marker("long", 0, 1e9), marker("always", 0)}),
              ros::Time(10.0));
  store.expire(ros::Time(10.49));
  EXPECT_EQ(shown(store).size(), 3u);
  store.apply("a", array({marker("short", 0, 0.5)}), ros::Time(10.49));
  store.expire(ros::Time(10.98));
  EXPECT_EQ(shown(store).size(), 3u) << "a new message begins a new lifetime";
  store.expire(ros::Time(10.99));
  EXPECT_EQ(shown(store), (Names{"a always 0", "a long 0"}));
  store.expire(ros::Time(1e9));
  EXPECT_EQ(shown(store), (Names{"a always 0", "a long 0"}));
}

TEST(MarkerStore, PlacesEachMarkerAtItsStampOnceItsTransformIsKnown) {
  MarkerStore store;
  Marker locked = marker("locked", 0);
  locked.frame_locked = 1;
  store.apply("a", array({locked, marker("free", 0)}), ros::Time(10.0));
  store.place([](const std::string&, const ros::Time&) { return std::nullopt; });
  EXPECT_FALSE(store.entries().at({"a", "free", 0}).T_fixed_header);

  const auto at = [](double x) {
    return [x](const std::string& frame, const ros::Time& stamp) {
      EXPECT_EQ(frame, "liver");
      return std::optional(Eigen::Isometry3d(Eigen::Translation3d(x, stamp.toSec(), 0.0)));
    };
  };
  store.place(at(1.0));
  store.place(at(2.0));
  EXPECT_TRUE(store.entries()
                  .at({"a", "free", 0})
                  .T_fixed_header->translation()
                  .isApprox(Eigen::Vector3d(1.0, 3.0, 0.0)));
  EXPECT_TRUE(store.entries()
                  .at({"a", "locked", 0})
                  .T_fixed_header->translation()
                  .isApprox(Eigen::Vector3d(2.0, 0.0, 0.0)))
      << "it follows its frame, with the latest transform";
}

}  // namespace
}  // namespace organ_collision
