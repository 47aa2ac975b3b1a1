#include "collision_node.hpp"

#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <utility>

#include "organ_collision/ros/names.hpp"
#include "ros/interface/conversions.hpp"
#include "ros/interface/plain_text.hpp"
#include "ros/interface/rejection.hpp"
#include "ros/publishing/markers.hpp"
#include "ros/steps/contact_array.hpp"
#include "ros/tools/tool_loader.hpp"

namespace organ_collision {
namespace {

using SteadyClock = std::chrono::steady_clock;

/// Waits at most this long, so that stopping and a jump of the clock are noticed.
constexpr std::chrono::milliseconds kLongestWait(10);
/// Callbacks are called for at most this long before what they brought is evaluated.
constexpr std::chrono::milliseconds kLongestDrain(2);

/// What is published on breaking down has so long to leave before its publishers close.
const ros::WallDuration kLastWords(1.0);

ros::NodeHandle on_queue(ros::NodeHandle node, ros::CallbackQueue& queue) {
  node.setCallbackQueue(&queue);
  return node;
}

MeshLimits limits(const NodeParameters& parameters) {
  return {static_cast<std::size_t>(parameters.max_faces)};
}

std::vector<Tool> load_tools(const std::vector<ToolParameters>& parameters,
                             const ros::NodeHandle& private_node) {
  std::vector<Tool> tools;
  for (const ToolParameters& of_tool : parameters)
    tools.push_back(load_tool(of_tool, private_node));
  return tools;
}

PathSampling sampling(const NodeParameters& parameters) {
  return {parameters.motion_sample_sec, parameters.motion_samples_max};
}

/// Ends the wait for a callback, and does no more.
class WakeUp : public ros::CallbackInterface {
 public:
  CallResult call() override { return Success; }
};

/// Of the node's last words: where one fails, the others are still said, and the exception that
/// they are about goes on.
template <typename Action>
void attempt(const Action& action) {
  try {
    action();
  } catch (const std::exception&) {  // Above all, that memory is short. No one is left to tell.
  }
}

/// Of a ContactArray, or of a batch.
template <typename Answer>
void count_failure(FailureLog& log, const Answer& answer) {
  if (answer.status == ContactArray::OK) return;
  log.add(reason_of(answer.status), answer.message, SteadyClock::now());
}

}  // namespace

CollisionNode::CollisionNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : node_(on_queue(node, queue_)),
      private_node_(on_queue(private_node, queue_)),
      loaded_(load_parameters(private_node_)),
      tools_(load_tools(loaded_.parameters.tools, private_node_)),
      organs_(limits(loaded_.parameters)),
      poses_(transforms_, sampling(loaded_.parameters)),
      contact_query_(loaded_.parameters.picker),
      steps_(loaded_.parameters, tools_, poses_, contact_query_,
             [this](const EvaluatedStep& step) { publish(step); }),
      services_({loaded_.parameters, tools_, organs_, transforms_, poses_, steps_.history(),
                 contact_query_}),
      diagnostics_({loaded_.parameters, tools_, loaded_.misspelt, organs_, contact_query_, steps_,
                    transforms_, counters_}),
      updater_(node_, private_node_, private_node_.getNamespace()),
      tool_is_due_(tools_.size(), false),
      contacts_(private_node_.advertise<ContactArray>(names::kContacts, 100)),
      markers_(private_node_.advertise<visualization_msgs::MarkerArray>(names::kMarkers, 100)),
      transform_topics_(transforms_, counters_.rejected),
      pose_topics_(loaded_.parameters.tools, {transforms_, counters_.rejected,
                                              [this](std::size_t tool) { tip_moved(tool); }}),
      inbox_(inbox_callbacks()) {
  for (const std::string& sentence : loaded_.misspelt) ROS_WARN("%s", sentence.c_str());
  for (const Tool& tool : tools_) {
    if (!tool.fault.empty()) ROS_ERROR("%s", tool.fault.c_str());
  }

  using MeshEvent = ros::MessageEvent<const OrganMesh>;
  const boost::function<void(const MeshEvent&)> add_mesh = [this](const MeshEvent& event) {
    inbox_.add(event.getConstMessage(), event.getConnectionHeaderPtr());
  };
  const auto no_delay = ros::TransportHints().tcpNoDelay();
  subscribers_ = {
      private_node_.subscribe<OrganMesh>(names::kOrganMesh, 100, add_mesh, {}, no_delay),
      private_node_.subscribe<OrganVertices>(
          names::kOrganVertices, 100,
          [this](const OrganVerticesConstPtr& message) { inbox_.add(message); }, {}, no_delay)};
  transform_topics_.subscribe(node_);
  pose_topics_.subscribe(node_);
  servers_ = {
      private_node_.advertiseService(names::kQuery, &CollisionNode::on_query, this),
      private_node_.advertiseService(names::kQueryBatch, &CollisionNode::on_query_batch, this),
      private_node_.advertiseService(names::kReset, &CollisionNode::on_reset, this)};
  if (loaded_.parameters.rate_hz > 0.0) {
    tick_ = private_node_.createTimer(ros::Duration(1.0 / loaded_.parameters.rate_hz),
                                      [this](const ros::TimerEvent&) { tick_is_due_ = true; });
  }
  diagnostics_.add_to(updater_);
  // Of wall time: the updater's own period stands still with simulated time, or waits for it.
  diagnostic_timer_ = private_node_.createWallTimer(
      ros::WallDuration(loaded_.parameters.diagnostic_period_sec),
      [this](const ros::WallTimerEvent&) { updater_.force_update(); });
  ROS_INFO("ready: %zu tools, GL %s", tools_.size(), contact_query_.gl_version().c_str());
}

void CollisionNode::run(const std::function<bool()>& stop) {
  try {
    while (private_node_.ok() && !stop()) {
      call_callbacks();
      evaluate();
    }
  } catch (const std::exception& error) {
    publish_breakdown(error.what());
    throw;
  }
}

/// Nobody may take what is missing from now on for the absence of contacts.
void CollisionNode::publish_breakdown(const std::string& why) {
  std::string message;
  attempt([&] {
    message = "the node broke down: " + why + "; once it is back, send the organs again";
    counters_.failed.add(reason_of(ContactArray::PICKER_FAILED), message, SteadyClock::now());
  });
  for (const auto& [name, organ] : organs_.organs()) {
    for (const Tool& tool : tools_) {
      attempt([&, &name = name, &organ = organ] {
        std_msgs::Header header;
        header.frame_id = organ.frame();
        publish_failure(tool, name, header, ContactArray::PICKER_FAILED, message);
      });
    }
  }
  attempt([this] { updater_.force_update(); });
  kLastWords.sleep();
}

void CollisionNode::evaluate() {
  steps_.evaluate_waiting(organs_, SteadyClock::now());
  for (std::size_t tool = 0; tool < tool_is_due_.size(); ++tool) {
    if (std::exchange(tool_is_due_[tool], false)) steps_.evaluate_latest(organs_, tool);
  }
  if (std::exchange(tick_is_due_, false)) steps_.evaluate_tick(organs_);
}

/// A tip that moves faster than steps are evaluated moves on within one.
void CollisionNode::tip_moved(std::size_t tool) {
  if (std::exchange(tool_is_due_[tool], true)) ++counters_.poses_merged;
}

void CollisionNode::call_callbacks() {
  SteadyClock::time_point until = SteadyClock::now() + kLongestWait;
  if (const auto deadline = steps_.next_deadline()) until = std::min(until, *deadline);
  const std::chrono::duration<double> wait = until - SteadyClock::now();

  bool called = call_one(ros::WallDuration(std::max(0.0, wait.count())));
  const SteadyClock::time_point end = SteadyClock::now() + kLongestDrain;
  while (called && SteadyClock::now() < end) called = call_one(ros::WallDuration(0.0));
  watch_clock();
  guard([this] { inbox_.hand_on(); });
}

/// False: there was none.
bool CollisionNode::call_one(ros::WallDuration wait) {
  watch_clock();
  bool called = true;
  guard([&] { called = queue_.callOne(wait) == ros::CallbackQueue::Called; });
  return called;
}

/// What a callback throws is counted, and the node goes on.
void CollisionNode::guard(const std::function<void()>& callback) {
  try {
    callback();
  } catch (const std::exception& error) {  // Above all, that memory is short.
    counters_.rejected.add("exception", error.what(), SteadyClock::now());
  }
}

/// Before each callback: what comes from after a jump must not meet what is from before.
void CollisionNode::watch_clock() {
  const ros::Time now = ros::Time::now();
  if (now < last_now_) {
    ROS_WARN("the clock jumped back from %f to %f s: all history is forgotten", last_now_.toSec(),
             now.toSec());
    transforms_.clear();
    pose_topics_.forget_stamps();
    organs_.forget_previous_shapes();
    organs_.forget_connections();
    steps_.start_anew(organs_);
  }
  last_now_ = now;
}

OrganMessageQueue::Callbacks CollisionNode::inbox_callbacks() {
  OrganMessageQueue::Callbacks callbacks;
  callbacks.make = [this](const OrganMeshConstPtr& message) { return organs_.make(message); };
  callbacks.is_known = [this](const OrganMesh& message, const Connection& connection) {
    return !organs_.is_new(message, connection);
  };
  callbacks.take = [this](const OrganMeshConstPtr& message, const Connection& connection,
                          const auto& made) {
    change_organ(*message,
                 [&](ros::Time now) { return organs_.apply(message, connection, now, made); });
  };
  callbacks.take_vertices = [this](const OrganVerticesConstPtr& message) {
    change_organ(*message, [&](ros::Time now) { return organs_.apply(message, now); });
  };
  callbacks.wake = [this] { queue_.addCallback(boost::make_shared<WakeUp>()); };
  return callbacks;
}

template <typename Message>
void CollisionNode::change_organ(const Message& message,
                                 const std::function<OrganChange(ros::Time)>& apply) {
  const SteadyTime now = SteadyClock::now();
  try {
    const OrganChange change = apply(ros::Time::now());
    if (change != OrganChange::kShape) steps_.forget(message.organ);
    if (change == OrganChange::kRemoved) {
      return publish_failure(message.organ, message.header, ContactArray::NO_MESH,
                             "organ '" + message.organ + "' was removed");
    }
    steps_.add_shape(organs_.at(message.organ), now);
    counters_.meshes.count();
  } catch (const Rejection& rejection) {
    counters_.rejected.add(rejection.reason(), rejection.what(), now);
    publish_failure(message.organ, message.header, rejection.status(), rejection.what());
  }
}

bool CollisionNode::on_query(QueryCollision::Request& request, QueryCollision::Response& response) {
  response.result = services_.query(request);
  count_failure(counters_.refused, response.result);
  return true;
}

bool CollisionNode::on_query_batch(QueryCollisionBatch::Request& request,
                                   QueryCollisionBatch::Response& response) {
  response = services_.query_batch(request);
  count_failure(counters_.refused, response);
  for (const ContactArray& result : response.results) count_failure(counters_.refused, result);
  return true;
}

bool CollisionNode::on_reset(std_srvs::Empty::Request&, std_srvs::Empty::Response&) {
  organs_.forget_previous_shapes();
  organs_.forget_connections();
  steps_.reset();
  return true;
}

void CollisionNode::publish(const EvaluatedStep& step) {
  count_failure(counters_.failed, *step.answer);
  contacts_.publish(step.answer);
  counters_.contacts.count();
  if (markers_.getNumSubscribers() > 0) markers_.publish(step_markers(step));
}

void CollisionNode::publish_failure(const std::string& organ, const std_msgs::Header& header,
                                    std::uint8_t status, const std::string& message) {
  for (const Tool& tool : tools_) publish_failure(tool, organ, header, status, message);
}

void CollisionNode::publish_failure(const Tool& tool, const std::string& organ,
                                    const std_msgs::Header& header, std::uint8_t status,
                                    const std::string& message) {
  const ros::Time stamp = header.stamp.isZero() ? ros::Time::now() : header.stamp;
  const auto answer = boost::make_shared<ContactArray>(
      answer_about(organ, tool.parameters.name, ContactArray::STATIC, stamp));
  set_links(*answer, tool.parameters);
  answer->header.frame_id = plain_text(tf_frame(header.frame_id), kLongestName);
  set_failure(*answer, status, message);
  contacts_.publish(answer);
}

}  // namespace organ_collision
