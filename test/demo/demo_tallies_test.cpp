#include "demo/demo_tallies.hpp"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>

namespace organ_collision {
namespace {

ProxyState state(std::uint8_t value, double force) {
  ProxyState state;
  state.state = value;
  state.wrench.force.y = -force;
  state.tick_sec = 30e-6;
  return state;
}

TEST(ProxyTally, TellsTheLatestStateAndTheGreatestForceOfALine) {
  ProxyTally tally;
  tally.add(state(ProxyState::FREE, 0.0));
  tally.add(state(ProxyState::TOUCHING, 1.24));
  tally.add(state(ProxyState::TOUCHING, 0.6));
  EXPECT_EQ(tally.take_line(0.5), "TOUCHING, up to 1.2 N, 6 poses/s");
  tally.add(state(ProxyState::FREE, 0.0));
  EXPECT_EQ(tally.take_line(0.5), "FREE, up to 0.0 N, 2 poses/s");
}

TEST(ProxyTally, TellsWhyThereIsNoAnswer) {
  ProxyTally tally;
  EXPECT_EQ(tally.answered(), 0U);
  ProxyState lost = state(ProxyState::NO_ANSWER, 0.3);
  lost.message = "there is no organ";
  tally.add(lost);
  EXPECT_EQ(tally.take_line(1.0), "NO_ANSWER: there is no organ");
  EXPECT_EQ(tally.answered(), 0U);
}

TEST(ProxyTally, SumsUpAllLines) {
  ProxyTally tally;
  EXPECT_EQ(tally.summary(),
            "0 poses, tissue held the proxy in 0% of them, with at most 0.0 N; 0 us a tick on "
            "average");
  for (int i = 0; i < 4; ++i) {
    tally.add(state(i == 0 ? ProxyState::FREE : ProxyState::TOUCHING, 0.5 * i));
    tally.take_line(1.0);
  }
  EXPECT_EQ(tally.summary(),
            "4 poses, tissue held the proxy in 75% of them, with at most 1.5 N; 30 us a tick on "
            "average");
}

/// A tool from (0.3, 0.2, 0.5) to (0.3, 0.2, 0.1) in the organ's frame, and two faces. One lies
/// 3 mm below the tip, the other 0.2 m to the side.
class StaticComparisonTest : public testing::Test {
 protected:
  StaticComparisonTest() {
    ros::Time::init();
    comparison_.set_triangles({0, 1, 2, 3, 4, 5});
    set_transform("organ", "trocar", 0.5, true);
  }

  void set_transform(const std::string& parent, const std::string& child, double z, bool is_static,
                     const ros::Time& stamp = ros::Time(7.0)) {
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = parent;
    transform.header.stamp = stamp;
    transform.child_frame_id = child;
    if (parent == "organ") {
      transform.transform.translation.x = 0.3;
      transform.transform.translation.y = 0.2;
    }
    transform.transform.translation.z = z;
    transform.transform.rotation.w = 1.0;
    transforms_.setTransform(transform, "test", is_static);
  }

  void add_shape(const ros::Time& stamp, float height) {
    comparison_.add_shape(
        stamp, {0.25f, 0.15f, height, 0.40f, 0.20f, height, 0.25f, 0.30f, height, 0.25f, 0.40f,
                height, 0.40f, 0.45f, height, 0.25f, 0.50f, height});
  }

  static ContactArrayConstPtr answer(const std::vector<std::uint32_t>& faces,
                                     const ros::Time& stamp = ros::Time(7.0)) {
    const auto answer = boost::make_shared<ContactArray>();
    answer->header.frame_id = "organ";
    answer->header.stamp = answer->mesh_stamp = stamp;
    answer->tool = "probe";
    for (const std::uint32_t face : faces) {
      answer->contacts.emplace_back();
      answer->contacts.back().face = face;
    }
    return answer;
  }

  const StaticComparison::Tally& tally() const { return comparison_.tallies().at("probe"); }

  TransformBuffer transforms_;
  StaticComparison comparison_{{{"probe", "trocar", "tip", 0.005}}, transforms_};
};

TEST_F(StaticComparisonTest, StartsWithNothingForEachTool) {
  EXPECT_EQ(tally().contacts, 0U);
  EXPECT_EQ(tally().missed_by_static, 0U);
  EXPECT_EQ(comparison_.waiting(), 0U);
}

TEST_F(StaticComparisonTest, CountsTheFacesThatAreOutOfReachWhenTheStepEnds) {
  set_transform("trocar", "tip", -0.4, false);
  add_shape(ros::Time(7.0), 0.097f);
  comparison_.add_answer(answer({0, 1}));
  EXPECT_EQ(tally().contacts, 2U);
  EXPECT_EQ(tally().missed_by_static, 1U);
}

TEST_F(StaticComparisonTest, LooksAtTheShapeOfTheAnswer) {
  set_transform("trocar", "tip", -0.4, false);
  add_shape(ros::Time(6.9), 0.097f);
  add_shape(ros::Time(7.0), 0.094f);  // 6 mm below the tip
  add_shape(ros::Time(7.1), 0.097f);
  comparison_.add_answer(answer({0}));
  EXPECT_EQ(tally().contacts, 1U);
  EXPECT_EQ(tally().missed_by_static, 1U);
}

TEST_F(StaticComparisonTest, WaitsForTheShape) {
  set_transform("trocar", "tip", -0.4, false);
  comparison_.add_answer(answer({0}));
  EXPECT_EQ(comparison_.waiting(), 1U);
  EXPECT_EQ(tally().contacts, 0U);
  add_shape(ros::Time(7.0), 0.097f);
  EXPECT_EQ(comparison_.waiting(), 0U);
  EXPECT_EQ(tally().contacts, 1U);
  EXPECT_EQ(tally().missed_by_static, 0U);
}

TEST_F(StaticComparisonTest, WaitsForThePose) {
  add_shape(ros::Time(7.0), 0.097f);
  comparison_.add_answer(answer({0}));
  EXPECT_EQ(comparison_.waiting(), 1U);
  set_transform("trocar", "tip", -0.4, false);
  add_shape(ros::Time(7.1), 0.097f);
  EXPECT_EQ(comparison_.waiting(), 0U);
  EXPECT_EQ(tally().contacts, 1U);
}

}  // namespace

}  // namespace organ_collision
