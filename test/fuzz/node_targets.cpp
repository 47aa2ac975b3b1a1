// All topics of the collision node and of haptic_proxy, in any order.
#include <organ_collision/ContactArray.h>

#include <boost/make_shared.hpp>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <string>

#include "fuzz_input.hpp"
#include "haptics/proxy_scene.hpp"
#include "haptics/tool_proxy.hpp"
#include "node/steps/collision_pipeline.hpp"
#include "test/check_contacts/contact_contract.hpp"
#include "test/node/tools/hand_made_tools.hpp"

using namespace organ_collision;

namespace {

// All topics of the node in any order: bytes from the wire, to the answers of steps. Kinds of
// message: mesh, vertices, /tf, /tf_static, a pose of a tip, a tick, a later time, a reset, a pose
// of the tip of another tool, and of its base.

std::vector<Tool> make_tools() {
  std::vector<Tool> tools = {shaft_tool("hook", 0.01), grasper(), shaft_tool("stylus", 0.01)};
  tools[2].parameters.tip_pose_topic = "stylus/pose";
  tools[2].parameters.base_pose_topic = "stylus/base";
  tools[0].parameters.tip_pose_topic = "hook/pose";
  tools[0].parameters.margin = 0.1;
  tools[0].parameters.max_near = 2;
  return tools;
}

NodeParameters make_parameters(const std::vector<Tool>& tools) {
  NodeParameters parameters;
  for (const Tool& tool : tools) parameters.tools.push_back(tool.parameters);
  parameters.threads = 1;
  parameters.max_faces = 100;
  parameters.motion_samples_max = 10;
  parameters.publish_regions = true;
  return parameters;
}

using Shapes = std::map<std::string, std::shared_ptr<const TriangleMesh>>;

Shapes shapes(const OrganRegistry& organs) {
  Shapes shapes;
  for (const auto& [name, organ] : organs.organs()) shapes[name] = organ.latest().mesh;
  return shapes;
}

void check_shapes(const OrganRegistry& organs) {
  for (const auto& [name, organ] : organs.organs()) {
    const TriangleMesh& mesh = *organ.latest().mesh;
    demand(mesh.face_count() > 0, "an organ has faces");
    for (std::size_t face = 0; face < mesh.face_count(); ++face) {
      for (const Eigen::Vector3d& corner : mesh.triangle(face)) {
        demand(corner.allFinite(), "the corners of faces are finite");
      }
    }
    summary(name, *organ.surface());
    doubts(name, mesh.box().cast<double>(), *organ.surface());
    organ.latest().age(ros::Time(50));
    demand(std::isfinite(info_of(organ).volume), "the volume is finite");
  }
}

/// Checks the answers of one node, in their order.
class AnswerCheck {
 public:
  void operator()(ContactArray answer) {
    demand(answer.status != ContactArray::PICKER_FAILED, "no step fails");
    answer.header.seq = ++seq_;  // As the publisher counts them.
    const Faults faults = contract_.check(answer, "node");
    if (!faults.empty()) std::cerr << faults.all().front().sentence << '\n';
    demand(faults.empty(), "answers keep their contract");
  }

 private:
  ContactContract contract_;
  std::uint32_t seq_ = 0;
};

/// The parts of CollisionPipeline. The workers are those of all inputs, because a new OpenGL
/// context takes 25 ms. They remember nothing.
class Node {
 public:
  Node() { go_to(50); }

  void take(FuzzInput& input) {
    switch (const int kind = input.byte() % 10; kind) {
      case 0:
        if (auto mesh = shared<OrganMesh>(input)) inbox_.intake.take_mesh(mesh);
        break;
      case 1:
        if (auto mesh = shared<OrganVertices>(input)) inbox_.intake.take_vertices(mesh);
        break;
      case 2:
      case 3:
        if (auto message = next_message<tf2_msgs::TFMessage>(input)) {
          inbox_.motion.take_transforms(*message, "fuzz", kind == 3);
        }
        break;
      case 4:
        if (auto pose = next_message<geometry_msgs::PoseStamped>(input)) {
          inbox_.motion.take_tip(0, *pose);
        }
        break;
      case 5:
        steps_.add_tick();
        break;
      case 6:
        go_to(input.byte());
        break;
      case 7:
        inbox_.begin_history("reset");
        break;
      default:
        if (auto pose = next_message<geometry_msgs::PoseStamped>(input)) {
          kind == 8 ? inbox_.motion.take_tip(2, *pose) : inbox_.motion.take_base(2, *pose);
        }
    }
    Shapes before = shapes(inbox_.organs);
    while (const auto update = inbox_.intake.next()) {
      steps_.add(*update, now_);
      Shapes after = shapes(inbox_.organs);
      demand(update->change || after == before, "a refused message changes nothing");
      before = std::move(after);
    }
    steps_.evaluate(now_);
  }

  /// Answers what still waits for transforms, and checks the organs.
  void finish() {
    while (const auto deadline = steps_.next_deadline()) {
      demand(*deadline > now_, "what is due was evaluated");
      now_ = *deadline;
      steps_.evaluate(now_);
    }
    check_shapes(inbox_.organs);
  }

 private:
  template <typename Message>
  static boost::shared_ptr<const Message> shared(FuzzInput& input) {
    const auto message = next_message<Message>(input);
    return message ? boost::make_shared<const Message>(*message) : nullptr;
  }
  void go_to(std::uint32_t seconds) {
    ros::Time::setNow(ros::Time(seconds, 0));
    inbox_.watch_clock();
  }
  static const std::vector<Tool>& tools() {
    static const std::vector<Tool> tools = make_tools();
    return tools;
  }
  static const NodeParameters& parameters() {
    static const NodeParameters parameters = make_parameters(tools());
    return parameters;
  }
  static StepWorkers& workers() {
    static StepWorkers workers(parameters());
    return workers;
  }

  FailureLog rejected_;
  SteadyTime now_{std::chrono::hours(1)};
  Inbox inbox_{parameters(), rejected_, [this](std::size_t tool) { steps_.add_pose(tool); }};
  ToolPoses poses_{inbox_.transforms, {0.001, 10}};
  AnswerCheck check_;
  StepScheduler steps_{parameters(),  tools(),
                       inbox_.organs, poses_,
                       workers(),     [this](const ToolStep& step) { check_(*step.answer); }};
};

void run_node_messages(const std::uint8_t* data, std::size_t size) {
  FuzzInput input(data, size);
  Node node;
  while (!input.empty()) node.take(input);
  node.finish();
}

const FuzzTarget node_messages_target("node_messages", run_node_messages);

// All topics of haptic_proxy in any order: bytes from the wire, to forces. Kinds of message: mesh,
// vertices, /tf, a pose of a tip.

constexpr double kHandMaxForce = 5.0;  // [N]

/// A stylus through a trocar, or a free tool.
Tool make_tool(bool is_free) {
  Tool tool = shaft_tool("stylus", 0.01);
  tool.parameters.tip_pose_topic = "stylus/pose";
  if (is_free) tool.parameters.freedom = ProxyFreedom::kFree;
  return tool;
}

HapticProxyParameters proxy_parameters() {
  HapticProxyParameters parameters;
  parameters.max_force = kHandMaxForce;
  parameters.max_torque = 1.0;
  parameters.damping = 1.0;
  parameters.puncture_force = 3.0;
  return parameters;
}

/// A tool and its proxy. All inputs share them, because a new OpenGL context takes 25 ms.
struct Hand {
  explicit Hand(bool is_free) : tool(make_tool(is_free)), proxy(tool, parameters) {}

  const HapticProxyParameters parameters = proxy_parameters();
  const Tool tool;
  ToolProxy proxy;
  ToolProxy::Time now{std::chrono::hours(1)};
};

/// What the node does with the messages of one hand.
class ProxyNode {
 public:
  explicit ProxyNode(Hand& hand) : hand_(hand) {
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
      const ros::Time now(50);
      const ProxyScene scene =
          proxy_scene(organs_, transforms_, frame_.name(), {}, now, [](const auto& organ) {
            return Timed<std::shared_ptr<const TriangleMesh>>{organ.latest().mesh, {}};
          });
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
    demand(sum.norm() <= kHandMaxForce * (1.0 + 1e-6), "the force is finite and limited");
    demand(report.answer || !report.message.empty(), "a tick without an answer has a message");
  }

  Hand& hand_;
  AheadLimit ahead_;
  OrganRegistry organs_{MeshLimits{100}, ahead_};
  TransformBuffer transforms_;
  FailureLog rejected_;
  MotionTopics motion_{{hand_.tool.parameters}, transforms_, rejected_, [](std::size_t) {}, ahead_};
  ToolPoses poses_{transforms_, {1.0, 1}};
  ProxyFrame frame_{""};
};

void run_haptic_proxy(const std::uint8_t* data, std::size_t size) {
  ros::Time::setNow(ros::Time(50));
  FuzzInput input(data, size);
  static Hand through_trocar(false), free(true);
  ProxyNode node(input.byte() % 2 == 1 ? free : through_trocar);
  while (!input.empty()) node.take(input);
}

const FuzzTarget haptic_proxy_target("haptic_proxy", run_haptic_proxy);

}  // namespace
