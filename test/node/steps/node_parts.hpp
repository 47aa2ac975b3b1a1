#pragma once

#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <ros/callback_queue.h>

#include <boost/make_shared.hpp>
#include <functional>
#include <string>
#include <vector>

#include "node/steps/collision_pipeline.hpp"
#include "test/grid_surface.hpp"
#include "test/node/motion/tool_poses_fixture.hpp"
#include "test/node/tools/hand_made_tools.hpp"

namespace organ_collision {

/// A wavy sheet of 2 * side * side faces, 2 m wide, at this height.
inline OrganMesh wavy_sheet(int side, double phase, float height) {
  const GridSurface grid = grid_surface(side, phase);
  OrganMesh mesh;
  mesh.triangles = grid.triangles();
  for (std::size_t i = 0; i < grid.vertices.size(); ++i) {
    mesh.vertices.push_back(i % 3 == 2 ? grid.vertices[i] + height : 10.0F * grid.vertices[i]);
  }
  return mesh;
}

/// The node without ROS's topics: messages are given by hand, and the clock stands still. The organ
/// is a horizontal sheet of two faces, 2 m wide; the tool hangs from (0, 0, 1). Nobody inspects
/// surfaces.
struct NodeParts {
  explicit NodeParts(int threads = 1, const std::vector<Tool>& list = {shaft_tool("hook", 0.01)})
      : tools(list), parameters(parameters_of(threads, list)) {
    ros::Time::init();
    ros::Time::setNow(ros::Time(50));
    set_point(transforms, "liver_frame", "hook_trocar", 0.0, {0.0, 0.0, 1.0}, true);
  }

  void send_tip(double time, const Eigen::Vector3d& tip) {
    set_point(transforms, "liver_frame", "hook_tip", time, tip);
  }

  static std::vector<float> heights(float z) { return {-1, -1, z, 1, -1, z, 1, 1, z, -1, 1, z}; }

  void send_mesh(double stamp, float z, std::uint32_t topology = 1) {
    OrganMesh message;
    message.topology = topology;
    message.triangles = {0, 1, 2, 0, 2, 3};
    message.vertices = heights(z);
    send_mesh(stamp, std::move(message));
  }
  /// The same with given vertices and triangles.
  void send_mesh(double stamp, OrganMesh message) {
    message.header.frame_id = "liver_frame";
    message.header.stamp = ros::Time(stamp);
    if (message.organ.empty()) message.organ = "liver";
    organ_topics.take_mesh(boost::make_shared<OrganMesh>(std::move(message)), connection);
    pipeline.apply_organ_messages(now);
  }

  /// The organ's sender ends, and starts again.
  void restart_sender() { connection = boost::make_shared<const ros::M_string>(); }

  void send_vertices(double stamp, float z) {
    OrganVertices message;
    message.header.frame_id = "liver_frame";
    message.header.stamp = ros::Time(stamp);
    message.organ = "liver";
    message.topology = 1;
    message.vertices = heights(z);
    organ_topics.take_vertices(boost::make_shared<OrganVertices>(message), connection);
    pipeline.apply_organ_messages(now);
  }

  /// What is published when everything that is due is evaluated, `later` after the last call.
  std::vector<ContactArray> evaluate(std::chrono::nanoseconds later = {}) {
    now += later;
    published.clear();
    steps.evaluate(now);
    return published;
  }

  std::vector<ContactArray> tick() {
    steps.add_tick();
    return evaluate();
  }

  static NodeParameters parameters_of(int threads, const std::vector<Tool>& tools) {
    NodeParameters parameters;
    parameters.threads = threads;
    for (const Tool& tool : tools) parameters.tools.push_back(tool.parameters);
    return parameters;
  }

  std::vector<Tool> tools;
  NodeParameters parameters;
  FailureLog rejected;
  ros::CallbackQueue callbacks;
  boost::shared_ptr<const ros::M_string> connection = boost::make_shared<const ros::M_string>();
  std::vector<ContactArray> published;
  SteadyTime now{std::chrono::hours(1)};
  /// Also called with each step, if set.
  std::function<void(const ToolStep&)> watch;
  CollisionPipeline pipeline{parameters,
                             tools,
                             rejected,
                             {[this](const ToolStep& step) {
                                published.push_back(*step.answer);
                                if (watch) watch(step);
                              },
                              [](const OrganUpdate&) {}},
                             OrganIntake::Threads{callbacks, callbacks, callbacks}};
  OrganRegistry& organs = pipeline.inbox.organs;
  OrganIntake& organ_topics = pipeline.inbox.intake;
  TransformBuffer& transforms = pipeline.inbox.transforms;
  ToolPoses& poses = pipeline.poses;
  StepScheduler& steps = pipeline.steps;
};

}  // namespace organ_collision
