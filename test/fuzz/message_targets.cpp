// What the node makes of single messages: paths of tools, shapes of organs, answers of services.
#include <boost/make_shared.hpp>
#include <optional>

#include "fuzz_input.hpp"
#include "ros/messages/conversions.hpp"
#include "ros/messages/text.hpp"
#include "ros/motion/motion_topics.hpp"
#include "ros/motion/tool_poses.hpp"
#include "ros/organs/organ_registry.hpp"
#include "test/ros/queries/query_fixtures.hpp"
#include "test/ros/tools/hand_made_tools.hpp"

using namespace organ_collision;

namespace {

// TFMessage and PoseStamped: bytes from the wire, to paths of tools. Kinds of message: /tf,
// /tf_static, a pose of a tip, a pose of a base.

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

void run_motion_messages(const std::uint8_t* data, std::size_t size) {
  ros::Time::setNow(ros::Time(50));
  FuzzInput input(data, size);
  Receivers receivers;
  while (!input.empty()) receivers.take(input);
  receivers.look_up();
}

const FuzzTarget motion_messages_target("motion_messages", run_motion_messages);

// OrganMesh and OrganVertices: bytes from the wire, to shapes of organs. Kinds of message: mesh,
// vertices.

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

template <typename Message>
void apply(FuzzInput& input, OrganRegistry& organs) {
  const auto message = next_message<Message>(input);
  if (!message) return;
  const Shapes before = shapes(organs);
  try {
    organs.apply(boost::make_shared<const Message>(*message), ros::Time(50));
  } catch (const Rejection&) {
    demand(shapes(organs) == before, "a refused message changes nothing");
  }
}

void run_organ_messages(const std::uint8_t* data, std::size_t size) {
  FuzzInput input(data, size);
  OrganRegistry organs{MeshLimits{1000}};
  while (!input.empty()) {
    if (input.byte() % 2 == 0) {
      apply<OrganMesh>(input, organs);
    } else {
      apply<OrganVertices>(input, organs);
    }
  }
  check_shapes(organs);
}

const FuzzTarget organ_messages_target("organ_messages", run_organ_messages);

// The services query and query_batch: bytes from the wire, to answers about an organ of two faces.
// Kinds of request: one motion, a batch.

/// A node with two shapes of an organ, a hook that has a shaft and links, a grasper that has only
/// links, and a probe that has only a shaft. Queries change nothing, so all inputs share it.
struct QueryNode : ServedNode {
  QueryNode() {
    parameters.max_batch = 50;
    parameters.max_batch_bytes = 200'000;
    tools = {with_links(shaft_tool("hook", 0.01)), grasper(), shaft_tool("probe", 0.02)};
    for (const char* frame : {"arm/wrist", "arm/jaw", "probe_trocar", "probe_tip"}) {
      set_point(transforms, "liver_frame", frame, 0.0, {0.1, 0.2, 0.3}, true);
    }
    send_mesh(1.0, 0.0);
    send_vertices(1.1, 0.1f);
    organs.at("liver").surface()->find();  // Otherwise queries wait until a thread has found it.
    send_tip(1.0, {0.1, 0.2, 0.3});
    evaluate();
    send_tip(1.1, {0.1, 0.2, -0.3});
  }
};

void check(std::uint8_t status, const std::string& message, bool has_results) {
  demand(status <= ContactArray::INVALID_TOOL, "the status is one of ContactArray's");
  demand(status != ContactArray::PICKER_FAILED, "no query fails");
  demand(status == ContactArray::OK || !has_results, "a failure has no results");
  demand(status == ContactArray::OK || !message.empty(), "a failure has a message");
  demand(message == plain_text(message, kLongestMessage), "a message is plain text");
}

void check(const ContactArray& answer) {
  check(answer.status, answer.message, !answer.contacts.empty());
  for (const Contact& contact : answer.contacts) {
    demand(contact.face < 2, "a contact's face exists");
    if (answer.mode >= ContactArray::PAPER_STATIC) continue;
    demand(to_eigen(contact.point).allFinite() && to_eigen(contact.normal).allFinite() &&
               std::isfinite(contact.depth),
           "contacts are finite");
  }
}

void run_query_requests(const std::uint8_t* data, std::size_t size) {
  static QueryNode node;
  FuzzInput input(data, size);
  if (input.byte() % 2 == 0) {
    const auto request = next_message<QueryCollision::Request>(input);
    if (request) check(node.services.query(*request));
  } else {
    const auto request = next_message<QueryCollisionBatch::Request>(input);
    if (!request) return;
    const QueryCollisionBatch::Response response = node.services.query_batch(*request);
    check(response.status, response.message, !response.results.empty());
    demand(response.results.size() <= 50, "no batch is larger than its limit");
    for (const ContactArray& answer : response.results) check(answer);
  }
}

const FuzzTarget query_requests_target("query_requests", run_query_requests);

}  // namespace
