#pragma once

#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>

#include <boost/make_shared.hpp>
#include <string>
#include <vector>

#include "ros/organs/organ_registry.hpp"
#include "ros/steps/query_services.hpp"
#include "ros/steps/step_scheduler.hpp"
#include "test/ros/motion/hand_filled_transforms.hpp"
#include "test/ros/tools/hand_made_tools.hpp"

namespace organ_collision {

/// All of the node but ROS: fed by hand, with a clock that stands still. The organ is a sheet of
/// two faces, 2 m wide, at a height; the tool hangs from (0, 0, 1).
struct NodeParts {
  NodeParts() {
    ros::Time::init();
    ros::Time::setNow(ros::Time(50));
    set_point(transforms, "liver_frame", "hook_trocar", 0.0, {0.0, 0.0, 1.0}, true);
  }

  void send_tip(double time, const Eigen::Vector3d& tip) {
    set_point(transforms, "liver_frame", "hook_tip", time, tip);
  }

  static std::vector<float> heights(float z) { return {-1, -1, z, 1, -1, z, 1, 1, z, -1, 1, z}; }

  void send_mesh(double stamp, float z, std::uint32_t topology = 1,
                 const std::string& frame = "liver_frame") {
    OrganMesh message;
    message.header.frame_id = frame;
    message.header.stamp = ros::Time(stamp);
    message.organ = "liver";
    message.topology = topology;
    message.vertices = heights(z);
    message.triangles = {0, 1, 2, 0, 2, 3};
    organs.apply(boost::make_shared<OrganMesh>(message), ros::Time::now());
    steps.add_shape(organs.at("liver"), now);
  }

  void send_vertices(double stamp, float z) {
    OrganVertices message;
    message.header.frame_id = "liver_frame";
    message.header.stamp = ros::Time(stamp);
    message.organ = "liver";
    message.topology = 1;
    message.vertices = heights(z);
    organs.apply(boost::make_shared<OrganVertices>(message), ros::Time::now());
    steps.add_shape(organs.at("liver"), now);
  }

  /// What is published when everything that can be is evaluated, `later` after the last call.
  std::vector<ContactArray> evaluate(std::chrono::milliseconds later = {}) {
    now += later;
    published.clear();
    steps.evaluate_waiting(organs, now);
    return published;
  }

  std::vector<ContactArray> tick() {
    published.clear();
    steps.evaluate_tick(organs);
    return published;
  }

  /// What is published when a pose of the tool comes.
  std::vector<ContactArray> pose() {
    published.clear();
    steps.evaluate_latest(organs, 0);
    return published;
  }

  NodeParameters parameters;
  std::vector<Tool> tools = {shaft_tool("hook", 0.01)};
  TransformBuffer transforms;
  OrganRegistry organs{MeshLimits{}};
  ToolPoses poses{transforms, {0.001, 100}};
  ContactQuery contact_query{PickerKind::kFeedback};
  std::vector<ContactArray> published;
  SteadyTime now{std::chrono::hours(1)};
  StepScheduler steps{parameters, tools, poses, contact_query,
                      [this](const EvaluatedStep& step) { published.push_back(*step.answer); }};
  QueryServices services{
      {parameters, tools, organs, transforms, poses, steps.history(), contact_query}};
};

}  // namespace organ_collision
