#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "test/node/steps/node_parts.hpp"

// How fast tissue moves, and how fast it comes near a tool.

using namespace organ_collision;

namespace {

/// What happens to a sheet in which a tool rests, and how fast it moves afterwards.
struct Row {
  const char* what;
  std::function<void(NodeParts&)> happens;
  double velocity;  ///< [m/s]
};

/// Sets the clock.
void pass(NodeParts& node, double time) {
  ros::Time::setNow(ros::Time(time));
  node.pipeline.watch_clock();
}

const std::vector<Row> kRows = {
    {"the first shape", [](NodeParts& node) { node.send_mesh(50.0, 0.0F); }, 0.0},
    {"the second one", [](NodeParts& node) { pass(node, 50.1), node.send_vertices(50.1, 0.1F); },
     1.0},
    {"a tick", [](NodeParts& node) { pass(node, 50.3), node.steps.add_tick(); }, 1.0},
    {"no shape for four periods", [](NodeParts& node) { pass(node, 50.55), node.steps.add_tick(); },
     1.0},
    {"nor for six", [](NodeParts& node) { pass(node, 50.7), node.steps.add_tick(); }, 0.0},
    {"a shape after this pause", [](NodeParts& node) { node.send_vertices(50.7, 0.25F); }, 0.25},
    {"a stamp that is repeated", [](NodeParts& node) { node.send_vertices(50.7, 0.3F); }, 0.0},
    {"a stamp that goes back", [](NodeParts& node) { node.send_vertices(50.6, 0.2F); }, 0.0},
    {"the next stamp", [](NodeParts& node) { pass(node, 50.8), node.send_vertices(50.8, 0.1F); },
     -0.5},
    {"other triangles", [](NodeParts& node) { node.send_mesh(50.9, 0.5F, 2); }, 0.0},
    {"the same triangles", [](NodeParts& node) { node.send_mesh(51.0, 0.4F, 2); }, -1.0},
    {"a reset", [](NodeParts& node) { node.pipeline.reset(), node.steps.add_tick(); }, 0.0},
    {"a shape after it", [](NodeParts& node) { node.send_mesh(51.1, 0.1F, 2); }, 0.0},
    {"the next one", [](NodeParts& node) { node.send_mesh(51.2, 0.2F, 2); }, 1.0},
    {"a shape that came long before its transform",
     [](NodeParts& node) { node.send_mesh(51.201, 0.201F, 2), pass(node, 50.85); }, 0.0},
    {"shapes that jump",
     [](NodeParts& node) {
       node.parameters.organ_motion = false;
       node.send_mesh(51.3, 0.25F, 2);
     },
     0.0},
    {"shapes that move again, without a stamp",
     [](NodeParts& node) {
       node.parameters.organ_motion = true;
       pass(node, 51.3), node.send_mesh(0.0, 0.0F, 2), node.evaluate();
       pass(node, 51.5), node.send_mesh(0.0, 0.1F, 2);
     },
     0.5},
    {"one that waited for the one before",
     [](NodeParts& node) { pass(node, 51.5001), node.send_mesh(0.0, 0.2F, 2); }, 0.0},
    {"a clock that jumps back",
     [](NodeParts& node) { pass(node, 40.0), node.send_mesh(40.0, 0.5F, 2); }, 0.0},
};

}  // namespace

TEST(Speed, OfTissueIsThatBetweenTheLastTwoShapesUntilTheNextOneIsOverdue) {
  NodeParts node;
  set_point(node.transforms, "liver_frame", "hook_tip", 0.0, {0.1, 0.2, -1.0}, true);
  for (const Row& row : kRows) {
    SCOPED_TRACE(row.what);
    row.happens(node);
    const std::vector<ContactArray> answers = node.evaluate();
    ASSERT_EQ(answers.size(), 1U);
    ASSERT_EQ(answers[0].contacts.size(), 1U) << answers[0].message;
    const Eigen::Vector3d velocity = to_eigen(answers[0].contacts[0].velocity);
    EXPECT_LT((velocity - row.velocity * Eigen::Vector3d::UnitZ()).norm(), 1e-4)
        << velocity.transpose();
  }
}

/// The tip goes down with 0.1 m/s, by poses at 20 Hz, then no pose comes any more.
TEST(Speed, OfAToolIsThatOfItsLastPosesUntilTheNextOneIsOverdue) {
  NodeParts node;
  node.tools[0].parameters.margin = 2.0;
  node.send_mesh(0.0, 0.0F);
  const auto speed_at = [&](double time) {
    pass(node, time);
    return node.tick().at(0).clearance.closing_speed;
  };
  for (const double time : {50.0, 50.05, 50.1}) {
    pass(node, time);
    node.send_tip(time, {0.1, 0.2, 0.5 - 0.1 * (time - 50.0)});
    EXPECT_NEAR(speed_at(time + 0.02), time > 50.0 ? 0.1 : 0.0, 1e-6);
  }
  EXPECT_NEAR(speed_at(50.3), 0.1, 1e-6);
  EXPECT_EQ(speed_at(50.4), 0.0);
}
