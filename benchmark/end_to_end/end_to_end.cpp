#include <diagnostic_msgs/DiagnosticArray.h>
#include <nodelet/loader.h>
#include <organ_collision/ContactArray.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <ros/callback_queue.h>
#include <ros/names.h>
#include <ros/node_handle.h>
#include <ros/ros.h>
#include <tf2_eigen/tf2_eigen.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <boost/shared_ptr.hpp>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <vector>

#include "benchmark/scenes/organ_surface.hpp"
#include "benchmark/scenes/tool_motions.hpp"
#include "echo.hpp"
#include "latency_report.hpp"

namespace organ_collision::bench {

/// A simulator without physics. It publishes a deforming organ and the poses of tools that pierce
/// it to the node `organ_collision` of its own namespace, which has the tools `tool0`, `tool1` ...
class Simulator {
 public:
  Simulator(std::size_t faces, std::size_t tools);

  /// Returns when the node has evaluated a shape of the organ with every tool. Throws
  /// std::runtime_error if that takes more than half a minute.
  void start();
  /// Publishes shapes at `rate` [Hz] for `seconds`, whether or not answers arrive.
  LatencyReport run(double rate, double seconds);

 private:
  struct Sent {
    ros::SteadyTime time;
    std::size_t answers;
  };

  void send_poses(ros::Time stamp);
  boost::shared_ptr<OrganVertices> next_shape(ros::Time stamp);
  void on_contacts(const ContactArrayConstPtr& contacts);
  void on_diagnostics(const diagnostic_msgs::DiagnosticArrayConstPtr& diagnostics);

  OrganSurface organ_;
  std::vector<std::vector<float>> shapes_;
  std::vector<ShaftMotion> tools_;
  std::size_t step_ = 0;
  std::vector<boost::shared_ptr<OrganVertices>> messages_;
  std::unordered_map<std::uint64_t, Sent> waiting_;
  LatencyReport* report_ = nullptr;
  double query_sec_ = 0.0;  ///< [s] the node's median time of a query

  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::Publisher mesh_, vertices_;
  ros::Subscriber contacts_, diagnostics_;
  tf2_ros::TransformBroadcaster transforms_;
  tf2_ros::StaticTransformBroadcaster static_transforms_;
};

namespace {

// Chosen so that at 1224 faces and 1 kHz the tip moves at 1 m/s, like a fast hand, and the organ at
// 0.2 m/s.
constexpr std::size_t kStepsAcross = 10;
constexpr double kOrganShare = 0.125;  // [1] share of SceneScale::organ_step
constexpr std::size_t kShapes = 8;
constexpr double kTwoPi = 6.283185307179586;
constexpr char kOrgan[] = "organ";

geometry_msgs::TransformStamped pose(const std::string& frame, const Eigen::Vector3d& point,
                                     ros::Time stamp) {
  geometry_msgs::TransformStamped transform =
      tf2::eigenToTransform(Eigen::Isometry3d(Eigen::Translation3d(point)));
  transform.header.frame_id = kOrgan;
  transform.header.stamp = stamp;
  transform.child_frame_id = frame;
  return transform;
}

std::string tool_frame(std::size_t tool, const char* end) {
  return "tool" + std::to_string(tool) + "_" + end;
}

}  // namespace

Simulator::Simulator(std::size_t faces, std::size_t tools) : organ_(make_organ(faces)) {
  const SceneScale scale(faces);
  for (std::size_t i = 0; i < kShapes; ++i) {
    shapes_.push_back(
        deformed(organ_.vertices, kTwoPi * i / kShapes, kOrganShare * scale.organ_step));
  }
  ToolMotions motions(organ_, scale);
  for (std::size_t i = 0; i < tools; ++i) tools_.push_back(motions.next(shapes_.front()));

  node_.setCallbackQueue(&queue_);
  const auto name = [](const char* topic) { return std::string("organ_collision/") + topic; };
  mesh_ = node_.advertise<OrganMesh>(name("organ_mesh"), 1, true);
  vertices_ = node_.advertise<OrganVertices>(name("organ_vertices"), 10);
  contacts_ = node_.subscribe(name("contacts"), 1000, &Simulator::on_contacts, this,
                              ros::TransportHints().tcpNoDelay());
  diagnostics_ = node_.subscribe("/diagnostics", 10, &Simulator::on_diagnostics, this);
}

void Simulator::start() {
  std::vector<geometry_msgs::TransformStamped> trocars;
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    trocars.push_back(pose(tool_frame(tool, "trocar"), tools_[tool].end.trocar, ros::Time::now()));
  }
  static_transforms_.sendTransform(trocars);

  OrganMesh mesh;
  mesh.header.frame_id = kOrgan;
  mesh.organ = kOrgan;
  mesh.vertices = organ_.vertices;
  mesh.triangles = organ_.triangles;
  mesh_.publish(mesh);

  LatencyReport report;
  report_ = &report;
  const ros::SteadyTime give_up = ros::SteadyTime::now() + ros::WallDuration(30.0);
  while (report.latencies.count() == 0) {
    if (!ros::ok() || ros::SteadyTime::now() > give_up) {
      throw std::runtime_error(node_.resolveName("organ_collision") +
                               " gives no contacts of organ '" + std::string(kOrgan) + "' with " +
                               std::to_string(tools_.size()) + " tools");
    }
    const ros::Time stamp = ros::Time::now();
    send_poses(stamp);
    const auto message = next_shape(stamp);
    waiting_[stamp.toNSec()] = {ros::SteadyTime::now(), 0};
    vertices_.publish(message);
    answer_until(ros::Time::now() + ros::Duration(0.1), queue_);
  }
  waiting_.clear();
}

LatencyReport Simulator::run(double rate, double seconds) {
  LatencyReport report;
  report.rate = rate;
  report_ = &report;
  const ros::Duration period(1.0 / rate);
  const auto count = static_cast<std::size_t>(seconds * rate);
  ros::Time tick = ros::Time::now() + period;
  for (; report.sent < count && ros::ok(); ++report.sent, tick += period) {
    // The answer to the last shape has half a period to arrive. Then come the poses and the next
    // shape, in this order, because a simulator knows a tool's pose before the shape that the tool
    // causes.
    answer_until(tick - period * 0.5, queue_);
    send_poses(tick);
    const auto message = next_shape(tick);
    answer_until(tick, queue_);
    waiting_[tick.toNSec()] = {ros::SteadyTime::now(), 0};
    vertices_.publish(message);
  }
  report.late = ros::Time::now() > tick + period;
  answer_until(ros::Time::now() + ros::Duration(0.5), queue_);
  report.skipped = waiting_.size();
  report.query_sec = query_sec_;
  waiting_.clear();
  return report;
}

/// The tips move back and forth.
void Simulator::send_poses(ros::Time stamp) {
  ++step_;
  const std::size_t phase = step_ % (2 * kStepsAcross);
  const std::size_t place = std::min(phase, 2 * kStepsAcross - phase);
  const double time = static_cast<double>(place) / static_cast<double>(kStepsAcross);
  std::vector<geometry_msgs::TransformStamped> tips;
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    tips.push_back(pose(tool_frame(tool, "tip"), tools_[tool].at(time).tip, stamp));
  }
  transforms_.sendTransform(tips);
}

/// Reuses a message that roscpp has released.
boost::shared_ptr<OrganVertices> Simulator::next_shape(ros::Time stamp) {
  auto free = std::find_if(messages_.begin(), messages_.end(),
                           [](const auto& message) { return message.use_count() == 1; });
  if (free == messages_.end()) {
    messages_.push_back(boost::make_shared<OrganVertices>());
    free = messages_.end() - 1;
  }
  OrganVertices& message = **free;
  message.header.frame_id = kOrgan;
  message.header.stamp = stamp;
  message.organ = kOrgan;
  message.vertices = shapes_[step_ % kShapes];
  return *free;
}

void Simulator::on_contacts(const ContactArrayConstPtr& contacts) {
  const auto sent = waiting_.find(contacts->mesh_stamp.toNSec());
  if (sent == waiting_.end()) return;
  if (contacts->status != ContactArray::OK) ++report_->failed;
  if (++sent->second.answers < tools_.size()) return;
  report_->latencies.add((ros::SteadyTime::now() - sent->second.time).toSec());
  waiting_.erase(sent);
}

void Simulator::on_diagnostics(const diagnostic_msgs::DiagnosticArrayConstPtr& diagnostics) {
  constexpr double kMicro = 1e-6;
  for (const auto& status : diagnostics->status) {
    for (const auto& entry : status.values) {
      if (entry.key == "query time, median [us]") {
        query_sec_ = kMicro * std::atof(entry.value.c_str());
      }
    }
  }
}

}  // namespace organ_collision::bench

namespace {

using organ_collision::bench::Echo;
using organ_collision::bench::print;
using organ_collision::bench::Simulator;

/// Does what a line of standard input asks for.
void obey(const std::string& line, Simulator& simulator) {
  std::istringstream words(line);
  std::string what;
  words >> what;
  if (double rate = 0.0, seconds = 0.0; what == "shapes" && words >> rate >> seconds) {
    print("shapes", simulator.run(rate, seconds));
  } else {
    throw std::runtime_error("what is '" + line + "'?");
  }
}

}  // namespace

// end_to_end external|nodelet|echo FACES TOOLS
// Measures the node organ_collision of its own namespace, which is already running (external), or
// the nodelet or an Echo in this process. When it gets answers, it prints an empty line. Then it
// reads what to measure from standard input and prints a line of JSON for each line that it reads:
//   shapes RATE SECONDS   the latencies from shapes to contacts, the shapes being sent at RATE [Hz]
int main(int argc, char** argv) {
  ros::init(argc, argv, "end_to_end");
  if (argc != 4) return std::cerr << "end_to_end external|nodelet|echo FACES TOOLS" << std::endl, 2;
  const std::string what = argv[1];
  const std::size_t faces = std::strtoul(argv[2], nullptr, 10);
  const std::size_t tools = std::strtoul(argv[3], nullptr, 10);
  const ros::NodeHandle node;
  try {
    std::unique_ptr<nodelet::Loader> loader;
    std::optional<Echo> echo;
    if (what == "echo") echo.emplace(tools);
    if (what == "nodelet") {
      loader = std::make_unique<nodelet::Loader>(false);
      const std::string name = ros::names::resolve("organ_collision");
      if (!loader->load(name, "organ_collision/CollisionNodelet", {}, {})) return 1;
    }
    Simulator simulator(faces, tools);
    simulator.start();
    std::cout << std::endl;
    for (std::string line; std::getline(std::cin, line) && ros::ok();) obey(line, simulator);
  } catch (const std::exception& error) {
    std::cerr << "end_to_end: " << error.what() << std::endl;
    return 1;
  }
}
