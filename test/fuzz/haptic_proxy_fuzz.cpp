// All topics of haptic_proxy in any order: bytes from the wire, to forces. Kinds of message: mesh,
// vertices, /tf, a pose of a tip.
#include <organ_collision/ContactArray.h>

#include <boost/make_shared.hpp>

#include "fuzz_input.hpp"
#include "haptic_proxy/proxy_scene.hpp"
#include "haptic_proxy/tool_proxy.hpp"
#include "ros/motion/motion_topics.hpp"
#include "ros/motion/tool_poses.hpp"
#include "ros/organs/organ_registry.hpp"
#include "test/ros/tools/hand_made_tools.hpp"

using namespace organ_collision;

namespace {

constexpr double kMaxForce = 5.0;  // [N]

/// A stylus through a trocar, or a free tool.
Tool make_tool(bool is_free) {
  Tool tool = shaft_tool("stylus", 0.01);
  tool.parameters.tip_pose_topic = "stylus/pose";
  if (is_free) tool.parameters.freedom = ProxyFreedom::kFree;
  return tool;
}

HapticProxyParameters make_parameters() {
  HapticProxyParameters parameters;
  parameters.max_force = kMaxForce;
  parameters.max_torque = 1.0;
  parameters.damping = 1.0;
  parameters.puncture_force = 3.0;
  return parameters;
}

/// A tool and its proxy. All inputs share them, because a new OpenGL context takes 25 ms.
struct Hand {
  explicit Hand(bool is_free) : tool(make_tool(is_free)), proxy(tool, parameters) {}

  const HapticProxyParameters parameters = make_parameters();
  const Tool tool;
  ToolProxy proxy;
  ToolProxy::Time now{std::chrono::hours(1)};
};

/// What the node does with the messages of one hand.
class Node {
 public:
  explicit Node(Hand& hand) : hand_(hand) {
    hand_.proxy.reset();
    // The force of the last input has faded.
    hand_.now += std::chrono::seconds(1);
    hand_.proxy.lose(ContactArray::OK, "the next input", "", hand_.now);
  }

  void take(FuzzInput& input) {
    switch (input.byte() % 4) {
      case 0:
        apply<OrganMesh>(input);
        break;
      case 1:
        apply<OrganVertices>(input);
        break;
      case 2:
        if (auto message = next_message<tf2_msgs::TFMessage>(input))
          motion_.take_transforms(*message, "fuzz", false);
        break;
      default:
        if (auto pose = next_message<geometry_msgs::PoseStamped>(input)) motion_.take_tip(0, *pose);
    }
    frame_.update(organs_);
    hand_.now += std::chrono::milliseconds(1);
    check(report());
  }

 private:
  template <typename Message>
  void apply(FuzzInput& input) {
    const auto message = next_message<Message>(input);
    if (!message) return;
    try {
      organs_.apply(boost::make_shared<const Message>(*message), ros::Time(50));
      for (const auto& [name, organ] : organs_.organs()) organ.surface()->find();
    } catch (const Rejection&) {
    }
  }

  ProxyReport report() {
    try {
      const auto pose = poses_.pose(hand_.tool, frame_.name(), ros::Time(0));
      if (!pose.found) throw Rejection(ContactArray::NO_TRANSFORM, "no pose", pose.why_not);
      const ProxyScene scene = proxy_scene(organs_, transforms_, frame_.name(), {}, ros::Time(50));
      ProxyReport report = hand_.proxy.follow(*pose.found, scene, hand_.now);
      report.scene = nullptr;  // It ends here.
      return report;
    } catch (const Rejection& rejection) {
      return hand_.proxy.lose(rejection.status(), rejection.what(), frame_.name(), hand_.now);
    } catch (const std::invalid_argument& error) {
      return hand_.proxy.lose(ContactArray::INVALID_REQUEST, error.what(), frame_.name(),
                              hand_.now);
    }
  }

  static void check(const ProxyReport& report) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const OrganForce& force : report.forces) sum += force.force;
    demand(sum.norm() <= kMaxForce * (1.0 + 1e-6), "the force is finite and limited");
    demand(report.answer || !report.message.empty(), "a tick without an answer has a message");
  }

  Hand& hand_;
  OrganRegistry organs_{MeshLimits{100}};
  TransformBuffer transforms_;
  FailureLog rejected_;
  MotionTopics motion_{{hand_.tool.parameters}, transforms_, rejected_, [](std::size_t) {}};
  ToolPoses poses_{transforms_, {1.0, 1}};
  ProxyFrame frame_{""};
};

}  // namespace

static const FuzzTarget target("haptic_proxy", [](const std::uint8_t* data, std::size_t size) {
  ros::Time::setNow(ros::Time(50));
  FuzzInput input(data, size);
  static Hand through_trocar(false), free(true);
  Node node(input.byte() % 2 == 1 ? free : through_trocar);
  while (!input.empty()) node.take(input);
});
