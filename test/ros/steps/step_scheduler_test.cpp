#include "ros/steps/step_scheduler.hpp"

#include <gtest/gtest.h>

#include <new>

#include "test/ros/steps/node_parts.hpp"

using namespace organ_collision;
using std::chrono::milliseconds;

namespace {

const Eigen::Vector3d kAbove{0.1, 0.2, 0.3};
const Eigen::Vector3d kBelow{0.1, 0.2, -0.3};

class StepSchedulerTest : public testing::Test, protected NodeParts {};

void expect_step(const std::vector<ContactArray>& published, std::uint8_t mode, double begin,
                 double end, std::size_t contacts) {
  ASSERT_EQ(published.size(), 1u);
  EXPECT_EQ(published[0].status, ContactArray::OK) << published[0].message;
  EXPECT_EQ(published[0].mode, mode);
  EXPECT_EQ(published[0].step_start, ros::Time(begin));
  EXPECT_EQ(published[0].header.stamp, ros::Time(end));
  EXPECT_EQ(published[0].contacts.size(), contacts);
}

constexpr auto kStatic = ContactArray::STATIC;
constexpr auto kSwept = ContactArray::SWEPT;

}  // namespace

TEST_F(StepSchedulerTest, APoseIsAnsweredOnce) {
  send_tip(1.0, kAbove);
  EXPECT_TRUE(pose().empty());
  send_mesh(1.0, 0.0);
  expect_step(pose(), kStatic, 1.0, 1.0, 0);  // The step of the first shape answers the pose, too.
  EXPECT_TRUE(pose().empty());
  send_tip(1.1, kBelow);
  expect_step(pose(), kSwept, 1.0, 1.1, 1);
  EXPECT_TRUE(pose().empty());
  send_tip(1.2, kAbove);
  send_vertices(1.2, 0.0);
  expect_step(evaluate(), kSwept, 1.1, 1.2, 1);
  EXPECT_TRUE(pose().empty());
}

TEST_F(StepSchedulerTest, OrganThatMovesThroughARestingTool) {
  send_tip(1.0, kAbove);
  send_tip(1.1, kAbove);
  send_mesh(1.0, -0.1f);
  expect_step(evaluate(), kStatic, 1.0, 1.0, 0);
  send_vertices(1.1, 1.5f);
  expect_step(evaluate(), kSwept, 1.0, 1.1, 2);
}

TEST_F(StepSchedulerTest, OrganJumpsWhereItsMotionIsNotWanted) {
  parameters.organ_motion = false;
  send_tip(1.0, kAbove);
  send_tip(1.1, kAbove);
  send_mesh(1.0, -0.1f);
  evaluate();
  send_vertices(1.1, 1.5f);
  expect_step(evaluate(), kSwept, 1.0, 1.1, 0);
}

TEST_F(StepSchedulerTest, NewTopologyRestsWhileTheToolIsSwept) {
  send_tip(1.0, kAbove);
  send_tip(1.1, kAbove);
  send_mesh(1.0, -0.1f);
  evaluate();
  send_mesh(1.1, 1.5f, 2);
  expect_step(evaluate(), kSwept, 1.0, 1.1, 0);
  send_tip(1.2, {0.1, 0.2, 2.0});
  send_mesh(1.2, 1.5f, 3);
  expect_step(evaluate(), kSwept, 1.1, 1.2, 1);
}

TEST_F(StepSchedulerTest, WaitsForTheTransform) {
  send_tip(1.0, kAbove);
  send_mesh(1.05, 0.0);
  EXPECT_TRUE(evaluate(milliseconds(10)).empty());
  ASSERT_TRUE(steps.next_deadline());
  EXPECT_EQ(*steps.next_deadline(), now + milliseconds(10));
  send_tip(1.1, kAbove);
  expect_step(evaluate(milliseconds(5)), kStatic, 1.05, 1.05, 0);
  EXPECT_FALSE(steps.next_deadline());
}

TEST_F(StepSchedulerTest, SweepsAcrossAGapInTheTransforms) {
  send_tip(1.0, kAbove);
  send_mesh(1.0, -2.0f);
  evaluate();
  send_vertices(1.1, 0.0f);
  EXPECT_TRUE(evaluate(milliseconds(19)).empty());
  const auto failed = evaluate(milliseconds(1));
  ASSERT_EQ(failed.size(), 1u);
  EXPECT_EQ(failed[0].status, ContactArray::NO_TRANSFORM);
  EXPECT_NE(failed[0].message.find("hook_tip"), std::string::npos);
  EXPECT_EQ(failed[0].header.stamp, ros::Time(1.1));
  EXPECT_EQ(failed[0].step_start, ros::Time(1.0));
  send_tip(1.2, kAbove);
  send_vertices(1.2, 2.0f);
  expect_step(evaluate(), kSwept, 1.0, 1.2,
              2);  // The organ moves from the shape before the gap, too.
}

TEST_F(StepSchedulerTest, WaitingShapeIsNotReplacedByNewerOnes) {
  send_mesh(1.0, 0.0);
  evaluate(milliseconds(5));
  send_vertices(1.1, 0.1f);
  evaluate(milliseconds(5));
  send_vertices(1.2, 0.2f);
  send_tip(1.0, kAbove);
  send_tip(1.3, kAbove);
  const auto published = evaluate();
  ASSERT_EQ(published.size(), 2u);
  EXPECT_EQ(published[0].mesh_stamp, ros::Time(1.0));
  EXPECT_EQ(published[1].mesh_stamp, ros::Time(1.2));
}

/// Compares all counts, whose sum must always be right.
void expect_shapes(const ShapeCounts& shapes, std::uint64_t answered, std::uint64_t superseded,
                   std::uint64_t forgotten, std::uint64_t waiting) {
  EXPECT_EQ(shapes.due, answered + superseded + forgotten + waiting);
  EXPECT_EQ(shapes.answered, answered);
  EXPECT_EQ(shapes.superseded, superseded);
  EXPECT_EQ(shapes.forgotten, forgotten);
  EXPECT_EQ(shapes.waiting, waiting);
}

TEST_F(StepSchedulerTest, TellsWhatBecameOfEachShape) {
  send_tip(1.0, kAbove);
  send_mesh(1.0, 0.0);
  expect_shapes(steps.shapes(), 0, 0, 0, 1);
  evaluate();
  expect_shapes(steps.shapes(), 1, 0, 0, 0);
  pose();
  tick();  // Poses and ticks bring no shape.
  expect_shapes(steps.shapes(), 1, 0, 0, 0);
  send_vertices(1.1, 0.1f);
  ASSERT_EQ(evaluate(milliseconds(20)).at(0).status, ContactArray::NO_TRANSFORM);
  expect_shapes(steps.shapes(), 2, 0, 0, 0);
  for (const double time : {1.2, 1.3, 1.4}) send_vertices(time, 0.1f);
  expect_shapes(steps.shapes(), 2, 1, 0, 2);
  steps.start_anew();
  expect_shapes(steps.shapes(), 2, 1, 2, 0);
  send_vertices(1.5, 0.1f);
  tools.clear();
  steps.change_tools({});
  expect_shapes(steps.shapes(), 2, 1, 3, 0);
}

TEST_F(StepSchedulerTest, CountsTheShapesOfARoundThatAnExceptionEnds) {
  tools.push_back(shaft_tool("needle", 0.01));
  set_point(transforms, "liver_frame", "needle_trocar", 0.0, {0.0, 0.0, 1.0}, true);
  set_point(transforms, "liver_frame", "needle_tip", 1.0, kAbove);
  send_tip(1.0, kAbove);
  send_mesh(1.0, 0.0);
  watch = [](const EvaluatedStep&) { throw std::bad_alloc(); };
  EXPECT_THROW(evaluate(), std::bad_alloc);
  expect_shapes(steps.shapes(), 1, 0, 1, 0);
}

TEST_F(StepSchedulerTest, SaysHowLateTransformsWereAndHowLongItWaited) {
  send_tip(1.0, kAbove);
  send_mesh(1.0073, 0.0);
  EXPECT_EQ(evaluate(milliseconds(20)).at(0).message,
            "TF from 'hook_tip' to 'liver_frame' is 7.3 ms behind the stamp 1.007300000; waited 20 "
            "ms (tf_timeout_sec)");
}

TEST_F(StepSchedulerTest, TheFirstMomentsOfAPairAreTold) {
  std::vector<bool> starting;
  watch = [&](const EvaluatedStep& step) { starting.push_back(step.is_starting); };
  send_mesh(1.0, 0.0);
  evaluate(milliseconds(20));  // Its first failure.
  tick();
  evaluate(milliseconds(1999));
  tick();
  evaluate(milliseconds(1));
  tick();
  EXPECT_EQ(starting, (std::vector<bool>{true, true, true, false}));
}

TEST_F(StepSchedulerTest, LateMeshFindsTheToolHeld) {
  send_tip(1.0, kAbove);
  send_tip(1.5, kBelow);
  send_mesh(1.5, -2.0f);
  expect_step(evaluate(), kStatic, 1.5, 1.5, 0);
  send_vertices(1.2, 0.0f);
  const auto published = evaluate();
  expect_step(published, kSwept, 1.5, 1.5, 1);
  EXPECT_EQ(published[0].mesh_stamp, ros::Time(1.2));
  send_tip(1.6, kBelow);
  send_vertices(1.6, 0.0f);
  expect_step(evaluate(), kSwept, 1.5, 1.6, 1);
}

TEST_F(StepSchedulerTest, TicksSweepTheToolAndHoldTheOrgan) {
  EXPECT_TRUE(tick().empty());
  send_mesh(1.0, -2.0f);
  EXPECT_TRUE(tick().empty());  // The first shape still waits for its transform.
  send_tip(1.0, kAbove);
  evaluate();
  expect_step(tick(), kSwept, 1.0, 1.0, 0);  // No newer transform: the tool rests.
  send_tip(1.1, kBelow);
  send_vertices(1.2, 0.0f);
  EXPECT_TRUE(evaluate().empty());
  expect_step(tick(), kSwept, 1.0, 1.1, 0);  // The new shape waits: the organ keeps its old shape.
  send_tip(1.2, kBelow);
  expect_step(evaluate(), kSwept, 1.1, 1.2, 1);
  expect_step(tick(), kSwept, 1.2, 1.2, 1);  // The change of shape counts only once.
}

TEST_F(StepSchedulerTest, TicksSayWhenTheMeshIsStale) {
  parameters.mesh_timeout_sec = 2.0;
  send_tip(49.0, kAbove);
  send_mesh(49.0, 0.0);
  evaluate();
  EXPECT_EQ(tick().at(0).status, ContactArray::OK);
  ros::Time::setNow(ros::Time(51.5));
  EXPECT_EQ(tick().at(0).status, ContactArray::STALE_MESH);
  EXPECT_EQ(tick().at(0).step_start, ros::Time(49.0));
}

TEST_F(StepSchedulerTest, ResetMakesTheNextStepStatic) {
  send_tip(1.0, kAbove);
  send_mesh(1.0, 0.0);
  evaluate();
  send_vertices(1.1, 0.0);
  steps.reset();
  EXPECT_EQ(steps.history().last("liver", 0), nullptr);
  send_tip(1.1, kBelow);
  const auto published = evaluate();  // The shape that waited has no history.
  expect_step(published, kStatic, 1.1, 1.1, 1);
  EXPECT_EQ(published[0].mesh_stamp, ros::Time(1.1));
}

TEST_F(StepSchedulerTest, RestingTransformsAreOfNow) {
  set_point(transforms, "liver_frame", "hook_tip", 0.0, kBelow, true);
  send_mesh(0.0, 0.0);
  expect_step(evaluate(), kStatic, 50.0, 50.0, 1);
  ros::Time::setNow(ros::Time(51.0));
  send_vertices(0.0, 0.0);
  expect_step(evaluate(), kSwept, 50.0, 51.0, 1);
}

TEST_F(StepSchedulerTest, AfterAChangeOfToolsAKeptToolSweepsOnAndANewOneIsStatic) {
  send_tip(1.0, kAbove);
  send_mesh(1.0, 0.0);
  expect_step(evaluate(), kStatic, 1.0, 1.0, 0);
  set_point(transforms, "liver_frame", "needle_trocar", 0.0, {0.0, 0.0, 1.0}, true);
  set_point(transforms, "liver_frame", "needle_tip", 1.0, kBelow);
  tools = {shaft_tool("needle", 0.01), tools[0]};
  steps.change_tools({std::nullopt, 0});
  const auto at_once = evaluate();
  expect_step(at_once, kStatic, 1.0, 1.0, 1);
  EXPECT_EQ(at_once[0].tool, "needle");

  send_tip(1.1, kBelow);
  set_point(transforms, "liver_frame", "needle_tip", 1.1, kAbove);
  send_vertices(1.1, 0.0);
  const auto next = evaluate();
  ASSERT_EQ(next.size(), 2u);
  for (const ContactArray& answer : next) {
    EXPECT_EQ(answer.mode, kSwept) << answer.tool;
    EXPECT_EQ(answer.step_start, ros::Time(1.0)) << answer.tool;
  }
}

TEST_F(StepSchedulerTest, AfterAChangeOfToolsWhatWaitsIsStillEvaluated) {
  send_tip(1.0, kAbove);
  send_mesh(1.0, 0.0);
  expect_step(evaluate(), kStatic, 1.0, 1.0, 0);
  send_vertices(1.1, 0.0);
  EXPECT_TRUE(evaluate().empty());  // It waits for its transform.
  tools.push_back(tools[0]);
  tools.erase(tools.begin());
  steps.change_tools({0});
  EXPECT_TRUE(evaluate().empty());
  send_tip(1.1, kBelow);
  expect_step(evaluate(), kSwept, 1.0, 1.1, 1);
}

/// The shape that waits is older than the organ's newest triangles, whose surface is known already.
TEST_F(StepSchedulerTest, AWaitingShapeIsPlacedByTheSurfaceOfItsOwnTriangles) {
  send_mesh(1.0, 0.0);
  organs.at("liver").surface()->find();
  OrganMesh tetrahedron;
  tetrahedron.organ = "liver";
  tetrahedron.header.frame_id = "liver_frame";
  tetrahedron.header.stamp = ros::Time(1.1);
  tetrahedron.topology = 2;
  tetrahedron.vertices = {-1, -1, -1, 2, -1, -1, -1, 2, -1, -1, -1, 2, 5, 5, 5};
  tetrahedron.triangles = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  organ_topics.take_mesh(boost::make_shared<OrganMesh>(tetrahedron));
  apply_organ_messages();
  organs.at("liver").surface()->find();
  for (const double time : {1.0, 1.1}) send_tip(time, {0.1, 0.15, -0.4});
  const auto published = evaluate();
  ASSERT_EQ(published.size(), 2u);
  EXPECT_EQ(published[0].status, ContactArray::OK) << published[0].message;
  EXPECT_EQ(published[0].topology, 1u);
  EXPECT_EQ(published[0].placement.tip, ToolPlacement::UNKNOWN);
  EXPECT_EQ(published[1].status, ContactArray::OK) << published[1].message;
  EXPECT_EQ(published[1].topology, 2u);
  EXPECT_EQ(published[1].placement.tip, ToolPlacement::INSIDE);
}

TEST_F(StepSchedulerTest, StepsAskForWhatTheParametersSay) {
  send_tip(1.0, {0.1, 0.2, 0.03});
  send_mesh(1.0, 0.0);
  const ContactArray plain = evaluate().at(0);
  EXPECT_EQ(plain.clearance.state, Clearance::NOT_ASKED);
  tools[0].parameters.margin = 0.1;
  tools[0].parameters.max_near = 1;
  const ContactArray measured = tick().at(0);
  EXPECT_EQ(measured.clearance.state, Clearance::KNOWN);
  EXPECT_NEAR(measured.clearance.distance, 0.02, 1e-9);
  EXPECT_EQ(measured.near.size(), 1u);
  send_tip(1.1, kBelow);
  EXPECT_EQ(tick().at(0).placement.crossings.size(), 1u);
  parameters.publish_placement = false;
  EXPECT_TRUE(tick().at(0).placement.crossings.empty());
}
