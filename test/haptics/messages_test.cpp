// The parts of the messages of haptic_proxy: forces on vertices, places, and the names of topics.
#include <gtest/gtest.h>
#include <organ_collision/ContactArray.h>
#include <ros/names.h>

#include <functional>
#include <limits>
#include <string>

#include "common/messages/conversions.hpp"
#include "haptics/places.hpp"
#include "haptics/proxy_publisher.hpp"
#include "haptics/topic_names.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

TEST(VertexForces, AForceIsDividedByTheBarycentricCoordinates) {
  ToolParameters tool;
  tool.name = "hook";
  const ProxyReport report{tool, "world", ros::Time(3, 7), ContactArray::OK, ""};
  OrganForce forces{"liver", "liver_frame", 4};
  forces.mesh_stamp = ros::Time(2, 9);
  forces.on_faces = {
      {0, kShaft, {7, 3, 900000}, {0.5, 0.25, 0.25}, Vector3d::Zero(), {0.0, 4.0, 8.0}},
      {1, kShaft, {3, 2, 5}, {0.75, 0.25, 0.0}, Vector3d::Zero(), {1.0, 0.0, 0.0}},
      {2, kShaft, {11, 12, 13}, {0.5, 0.25, 0.25}, Vector3d::Zero(), {0.0, 0.0, 0.0}}};
  const VertexForces found = vertex_forces_of(report, forces);
  EXPECT_EQ(found.header.stamp, report.stamp);
  EXPECT_EQ(found.header.frame_id, "liver_frame");
  EXPECT_EQ(found.mesh_stamp, forces.mesh_stamp);
  EXPECT_EQ(found.organ, "liver");
  EXPECT_EQ(found.tool, "hook");
  EXPECT_EQ(found.topology, 4u);
  EXPECT_EQ(found.vertices, (std::vector<std::uint32_t>{2, 3, 7, 900000}));
  ASSERT_EQ(found.forces.size(), 4u);
  EXPECT_EQ(to_eigen(found.forces[0]), Vector3d(-0.25, 0.0, 0.0));
  EXPECT_EQ(to_eigen(found.forces[1]), Vector3d(-0.75, -1.0, -2.0));
  EXPECT_EQ(to_eigen(found.forces[2]), Vector3d(0.0, -2.0, -4.0));
  EXPECT_EQ(to_eigen(found.forces[3]), Vector3d(0.0, -1.0, -2.0));
}

// Each row breaks one number of a report whose numbers may leave the node.
TEST(FaultOf, IsWhatIsNotFiniteOrExceedsItsLimitOrIsNoTipOfTheHand) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  ToolParameters tool;
  tool.name = "hook";
  tool.radius = 0.003;
  tool.tip_offset = {0.0, 0.0, 0.02};
  ProxyAnswer answer;
  answer.contacts.emplace_back();
  const struct {
    const char* words;
    std::function<void(ProxyReport&)> breaks;
    double before;  ///< [N], [N m] what left last
  } rows[] = {
      {"", [](auto&) {}, 0.0},
      {"force is 3.5 N; at most 3 N", [](auto& r) { r.forces[0].force.z() = 3.5; }, 0.0},
      {"", [](auto& r) { r.forces[0].force.z() = 3.5; }, 3.5},
      {"torque is 0.13 N m", [](auto& r) { r.forces[0].torque.y() = -0.12; }, 0.1},
      {"force is nan", [](auto& r) { r.forces[0].force.x() = kNan; }, 100.0},
      {"torque is inf", [](auto& r) { r.forces[0].torque.x() = kUnlimited; }, 100.0},
      {"not a finite", [](auto& r) { r.forces[0].on_faces[0].force.x() = kNan; }, 0.0},
      {"not a finite", [](auto& r) { r.center.y() = kNan; }, 0.0},
      {"not a finite", [&](auto&) { answer.proxy.axis.tip.z() = kNan; }, 0.0},
      {"not a finite", [&](auto&) { answer.contacts[0].contact.normal.z() = kNan; }, 0.0},
      {"2e+06 m from the tip", [](auto& r) { r.tip_frame->translation().x() += 2e6; }, 0.0},
      {"nan m from the tip", [](auto& r) { r.tip_frame->linear()(0, 2) = kNan; }, 0.0},
  };
  for (const auto& row : rows) {
    ProxyReport report{tool, "world", ros::Time(3, 7), ContactArray::OK, ""};
    report.limits = {3.0, 0.1, 300.0, 10.0};
    report.forces = {{"liver", "liver_frame", 4, {0.0, 0.0, 2.0}, {0.05, 0.0, 0.0}}};
    report.forces[0].on_faces = {
        {0, kShaft, {7, 3, 9}, {0.5, 0.25, 0.25}, Vector3d::Zero(), {0.0, 0.0, 2.0}}};
    report.hand = ToolPose{{{0.0, 0.0, 0.3}, {0.0, 0.0, 0.02}}};
    report.tip_frame = Eigen::Isometry3d::Identity();
    const ProxyAnswer whole = answer;
    report.answer = &answer;
    row.breaks(report);
    const std::string fault = fault_of(report, row.before, row.before);
    EXPECT_NE(fault.find(row.words), std::string::npos) << row.words << ": " << fault;
    EXPECT_EQ(fault.empty(), std::string(row.words).empty()) << fault;
    answer = whole;
  }
}

TEST(PairNames, AreLegalNamesOfTheGraph) {
  EXPECT_EQ(pair_graph_name("Liver_2", "hook"), "Liver_2/hook");
  EXPECT_EQ(pair_graph_name("left lobe", "robot1/hook"), "left_lobe/robot1_hook");
  EXPECT_EQ(pair_graph_name("2", "_x"), "organ_2/tool__x");
  EXPECT_EQ(pair_graph_name("", "~"), "organ_/tool__");
  for (const char* name : {"9-7", "f\xC3\xB6ie", " ", "a\nb", "..", "://"}) {
    std::string error;
    EXPECT_TRUE(ros::names::validate(pair_graph_name(name, name), error)) << error;
  }
}

}  // namespace
}  // namespace organ_collision
