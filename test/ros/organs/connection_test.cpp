#include "ros/organs/connection.hpp"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>

using namespace organ_collision;

namespace {

/// A header such as roscpp makes for each connection.
ros::M_stringPtr header() {
  return ros::M_stringPtr(new ros::M_string{{"callerid", "/simulator"}});
}

}  // namespace

TEST(ConnectionSet, KnowsConnectionsAndNotWhatTheirHeadersSay) {
  const ros::M_stringPtr first = header(), second = header();
  ConnectionSet known;
  EXPECT_FALSE(known.contains(first));
  known.add(first);
  known.add(first);
  EXPECT_TRUE(known.contains(first));
  EXPECT_FALSE(known.contains(second));
  known.add(second);
  EXPECT_TRUE(known.contains(first));
  EXPECT_TRUE(known.contains(second));
}

TEST(ConnectionSet, AMessageWithoutConnectionIsOfOneThatIsKnownOnceAdded) {
  ConnectionSet known;
  EXPECT_FALSE(known.contains({}));
  known.add({});
  EXPECT_TRUE(known.contains({}));
  EXPECT_FALSE(known.contains(header()));
}

TEST(ConnectionSet, ANewConnectionIsNotTakenForAClosedOneAtItsAddress) {
  ConnectionSet known;
  int at_the_same_address = 0;
  for (int i = 0; i < 100; ++i) {
    ros::M_stringPtr closed = header();
    const ros::M_string* address = closed.get();
    known.add(closed);
    closed.reset();
    const ros::M_stringPtr opened = header();
    at_the_same_address += opened.get() == address ? 1 : 0;
    EXPECT_FALSE(known.contains(opened));
  }
  EXPECT_GT(at_the_same_address, 0) << "this run of the test has shown nothing";
}
