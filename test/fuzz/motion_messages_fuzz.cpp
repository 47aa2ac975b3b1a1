// TFMessage and PoseStamped: bytes from the wire, to paths of tools. Kinds of message: /tf,
// /tf_static, a pose of a tip, a pose of a base.
#include <optional>

#include "fuzz_input.hpp"
#include "ros/motion/motion_topics.hpp"
#include "ros/motion/tool_poses.hpp"
#include "test/ros/tools/hand_made_tools.hpp"

using namespace organ_collision;

namespace {

/// A hook on TF that has a shaft and links, and a stylus whose poses are messages.
std::vector<Tool> make_tools() {
  std::vector<Tool> tools = {with_links(shaft_tool("hook", 0.01)), shaft_tool("stylus", 0.01)};
  tools[1].parameters.tip_pose_topic = "stylus/pose";
  tools[1].parameters.base_pose_topic = "stylus/base";
  return tools;
}

class Receivers {
 public:
  void take(FuzzInput& input) {
    const std::uint8_t kind = input.byte() % 4;
    if (kind < 2) {
      const auto message = next_message<tf2_msgs::TFMessage>(input);
      if (message) motion_.take_transforms(*message, "fuzz", kind == 1);
    } else {
      const auto pose = next_message<geometry_msgs::PoseStamped>(input);
      if (pose && kind == 2) motion_.take_tip(1, *pose);
      if (pose && kind == 3) motion_.take_base(1, *pose);
    }
  }

  void look_up() {
    const ToolPoses poses(buffer_, {0.001, 20});
    for (const Tool& tool : tools_) {
      std::optional<Timed<ToolPose>> last;
      // The last one: as late as a stamp can be.
      for (const ros::Time time : {ros::Time(1), ros::Time(49, 999'999'999), ros::Time(0),
                                   ros::Time(0xffffffffu, 999'999'999)}) {
        const auto pose = poses_.pose(tool, "world", time);
        demand(pose.found || !pose.why_not.empty(), "a pose that is not found has a reason");
        if (!pose.found) continue;
        if (last && last->stamp <= pose.found->stamp)
          check(poses_.path(tool, "world", *last, *pose.found));
        last = pose.found;
        poses_.set_answered(tool, "world", time);
      }
    }
  }

 private:
  static void check(const SampledPath& path) {
    demand(path.path.size() <= 20 + 1, "a path has at most so many waypoints");
    for (const ToolWaypoint& waypoint : path.path) {
      demand(waypoint.axis.trocar.allFinite() && waypoint.axis.tip.allFinite(),
             "waypoints are finite");
      demand(waypoint.fraction >= 0.0 && waypoint.fraction <= 1.0, "fractions are in [0, 1]");
    }
  }

  std::vector<Tool> tools_ = make_tools();
  std::vector<ToolParameters> parameters_ = {tools_[0].parameters, tools_[1].parameters};
  TransformBuffer buffer_;
  FailureLog rejected_;
  MotionTopics motion_{parameters_, buffer_, rejected_, [](std::size_t) {}};
  ToolPoses poses_{buffer_, {0.001, 20}};
};

}  // namespace

static const FuzzTarget target("motion_messages", [](const std::uint8_t* data, std::size_t size) {
  ros::Time::setNow(ros::Time(50));
  FuzzInput input(data, size);
  Receivers receivers;
  while (!input.empty()) receivers.take(input);
  receivers.look_up();
});
