#pragma once

#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <ros/callback_queue.h>

#include <boost/make_shared.hpp>
#include <functional>
#include <string>
#include <vector>

#include "ros/organs/organ_intake.hpp"
#include "ros/organs/organ_registry.hpp"
#include "ros/steps/contact_array.hpp"
#include "ros/steps/step_scheduler.hpp"
#include "test/ros/motion/tool_poses_fixture.hpp"
#include "test/ros/tools/hand_made_tools.hpp"

namespace organ_collision {

/// The node without ROS's topics: messages are given by hand, and the clock stands still. The organ
/// is a horizontal sheet of two faces, 2 m wide; the tool hangs from (0, 0, 1).
struct NodeParts {
  explicit NodeParts(int threads = 1) : parameters(with_threads(threads)) {
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
    organ_topics.take_mesh(boost::make_shared<OrganMesh>(message));
    apply_organ_messages();
  }

  void send_vertices(double stamp, float z) {
    OrganVertices message;
    message.header.frame_id = "liver_frame";
    message.header.stamp = ros::Time(stamp);
    message.organ = "liver";
    message.topology = 1;
    message.vertices = heights(z);
    organ_topics.take_vertices(boost::make_shared<OrganVertices>(message));
    apply_organ_messages();
  }

  void apply_organ_messages() {
    while (const auto update = organ_topics.next()) steps.add(*update, now);
  }

  /// What is published when everything that is due is evaluated, `later` after the last call.
  std::vector<ContactArray> evaluate(std::chrono::milliseconds later = {}) {
    now += later;
    published.clear();
    steps.evaluate(now);
    return published;
  }

  std::vector<ContactArray> tick() {
    steps.add_tick();
    return evaluate();
  }

  /// What is published when a pose of the first tool comes.
  std::vector<ContactArray> pose() {
    steps.add_pose(0);
    return evaluate();
  }

  static NodeParameters with_threads(int threads) {
    NodeParameters parameters;
    parameters.threads = threads;
    return parameters;
  }

  NodeParameters parameters;
  std::vector<Tool> tools = {shaft_tool("hook", 0.01)};
  TransformBuffer transforms;
  OrganRegistry organs{MeshLimits{}};
  FailureLog rejected;
  ros::CallbackQueue callbacks;
  OrganIntake organ_topics{organs, rejected, OrganIntake::Threads{callbacks, callbacks, callbacks}};
  ToolPoses poses{transforms, {0.001, 100}};
  StepWorkers workers{parameters};
  std::vector<ContactArray> published;
  SteadyTime now{std::chrono::hours(1)};
  /// Also called with each step, if set.
  std::function<void(const EvaluatedStep&)> watch;
  StepScheduler steps{parameters, tools, organs, poses, workers, [this](const EvaluatedStep& step) {
                        published.push_back(*step.answer);
                        if (watch) watch(step);
                      }};
};

}  // namespace organ_collision
