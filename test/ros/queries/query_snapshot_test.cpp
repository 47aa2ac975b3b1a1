#include "ros/queries/query_snapshot.hpp"

#include <gtest/gtest.h>

#include <string>

#include "ros/messages/failure_log.hpp"
#include "test/ros/steps/node_parts.hpp"

using namespace organ_collision;

namespace {

const Eigen::Vector3d kAbove{0.1, 0.2, 0.3}, kBelow{0.1, 0.2, -0.3};

class QuerySnapshotTest : public testing::Test, protected NodeParts {
 protected:
  QuerySnapshotTest() {
    header.frame_id = "/liver_frame";
    send_mesh(1.0, 0.0);
  }

  QuerySnapshot take(bool moves_as_in_tf, QueryMode mode = QueryMode::kSwept) {
    answer = {};
    answer.header.stamp = answer.step_start = ros::Time(7.0);
    return take_snapshot({parameters, tools, organs, transforms, poses, steps.history()},
                         {header, organ, tool, moves_as_in_tf, mode}, answer);
  }

  int status_of_refusal(bool moves_as_in_tf) {
    try {
      take(moves_as_in_tf);
    } catch (const Rejection& rejection) {
      return rejection.status();
    }
    return ContactArray::OK;
  }

  std_msgs::Header header;
  std::string organ = "liver", tool;
  ContactArray answer;
};

}  // namespace

TEST_F(QuerySnapshotTest, KeepsTheShapesWhileTheNodeGoesOn) {
  send_vertices(1.1, 0.5);
  const QuerySnapshot snapshot = take(false);
  EXPECT_EQ(answer.header.frame_id, "liver_frame");
  EXPECT_EQ(answer.mesh_stamp, ros::Time(1.1));
  EXPECT_EQ(answer.topology, 1u);
  EXPECT_EQ(answer.header.stamp, ros::Time(7.0));
  EXPECT_FALSE(snapshot.tool);
  for (int i = 0; i < 5; ++i) send_vertices(2.0 + i, 9.0);
  EXPECT_EQ(snapshot.latest.mesh->vertices()[2], 0.5F);
  EXPECT_EQ(snapshot.previous.mesh->vertices()[2], 0.0F);
  EXPECT_EQ(snapshot.latest.stamp, ros::Time(1.1));
}

TEST_F(QuerySnapshotTest, KeepsTheTool) {
  tool = "hook";
  const QuerySnapshot snapshot = take(false);
  tools = {};
  ASSERT_TRUE(snapshot.tool);
  EXPECT_EQ(snapshot.tool->parameters.radius, 0.01);
  EXPECT_TRUE(snapshot.path.empty());
}

TEST_F(QuerySnapshotTest, PosesThatRestAreOfThePresentAlsoIfTheLastStepWasLater) {
  tool = "hook";
  set_point(transforms, "liver_frame", "hook_tip", 0.0, kAbove, true);
  evaluate();
  tick();  // At 50 s, which is later than the time of the query.
  take(true);
  EXPECT_EQ(answer.header.stamp, ros::Time(50.0));
  EXPECT_EQ(answer.step_start, ros::Time(50.0));
}

TEST_F(QuerySnapshotTest, RefusalsLeaveWhatIsKnownInTheAnswer) {
  tool = "hook";
  EXPECT_EQ(status_of_refusal(true), ContactArray::NO_TRANSFORM);
  EXPECT_EQ(answer.mesh_stamp, ros::Time(1.0));
  EXPECT_EQ(answer.links, std::vector<std::string>{""});
  tool = "saw";
  EXPECT_EQ(status_of_refusal(false), ContactArray::UNKNOWN_TOOL);
  tool = "";
  organ = "spleen";
  EXPECT_EQ(status_of_refusal(false), ContactArray::UNKNOWN_ORGAN);
  organ = "";
  EXPECT_EQ(status_of_refusal(false), ContactArray::INVALID_REQUEST);
  organ = "liver";
  header.frame_id = "";
  EXPECT_EQ(status_of_refusal(false), ContactArray::INVALID_REQUEST);
  parameters.mesh_timeout_sec = 2.0;
  EXPECT_EQ(status_of_refusal(false), ContactArray::STALE_MESH);
}
