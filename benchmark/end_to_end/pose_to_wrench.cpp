#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <nodelet/loader.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/ros.h>
#include <tf2_eigen/tf2_eigen.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <boost/make_shared.hpp>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <unordered_map>
#include <vector>

#include "benchmark/scenes/organ_surface.hpp"
#include "benchmark/scenes/tool_motions.hpp"
#include "echo.hpp"
#include "latency_report.hpp"

namespace organ_collision::bench {

/// A haptic device and a simulator for the node `haptic_proxy` of its own namespace and its tool
/// `tool0`. The device publishes the poses of a hand that slides 5 mm below the surface of a
/// WavingOrgan, and receives wrenches. The organ has a new shape between each two poses, or every
/// tenth one if it has more than 10 000 faces.
class Hand {
 public:
  explicit Hand(std::size_t faces);

  /// Returns when the node has answered a pose with a force. Throws std::runtime_error if that
  /// takes more than half a minute.
  void start();
  /// Publishes poses at 1 kHz for `seconds`, whether or not answers arrive.
  LatencyReport run(double seconds);

 private:
  void send_pose(ros::Time stamp);
  void send_shape();
  void on_wrench(const geometry_msgs::WrenchStampedConstPtr& wrench);

  WavingOrgan organ_;
  std::vector<ToolPose> lap_;
  std::size_t shape_period_;  ///< [ticks]
  std::size_t tick_ = 0;
  std::unordered_map<std::uint64_t, ros::SteadyTime> waiting_;  ///< by the stamp of the pose [ns]
  LatencyReport* report_ = nullptr;

  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::Publisher mesh_, vertices_, poses_;
  ros::Subscriber wrenches_;
  tf2_ros::StaticTransformBroadcaster static_transforms_;
};

namespace {

constexpr double kDepth = 0.005;  // [m]
constexpr double kRate = 1000.0;  // [Hz] of poses
constexpr char kOrgan[] = "organ";
/// A longer pause of the poses would be a hand that is lost, whose force fades.
const ros::Duration kLastAnswers(0.05);

}  // namespace

Hand::Hand(std::size_t faces)
    : organ_(faces), lap_(sliding_lap(kDepth)), shape_period_(faces > 10'000 ? 10 : 1) {
  node_.setCallbackQueue(&queue_);
  mesh_ = node_.advertise<OrganMesh>("haptic_proxy/organ_mesh", 1, true);
  vertices_ = node_.advertise<OrganVertices>("haptic_proxy/organ_vertices", 10);
  poses_ = node_.advertise<geometry_msgs::PoseStamped>("hand/pose", 10);
  wrenches_ = node_.subscribe("haptic_proxy/organ/tool0/wrench", 1000, &Hand::on_wrench, this,
                              ros::TransportHints().tcpNoDelay());
}

void Hand::start() {
  geometry_msgs::TransformStamped trocar =
      tf2::eigenToTransform(Eigen::Isometry3d(Eigen::Translation3d(lap_.front().axis.trocar)));
  trocar.header.frame_id = kOrgan;
  trocar.header.stamp = ros::Time::now();
  trocar.child_frame_id = "tool0_trocar";
  static_transforms_.sendTransform(trocar);

  OrganMesh mesh;
  mesh.header.frame_id = kOrgan;
  mesh.organ = kOrgan;
  mesh.vertices = *organ_.shape(0);
  mesh.triangles = organ_.middle().triangles;
  mesh_.publish(mesh);

  LatencyReport report;
  report_ = &report;
  const ros::SteadyTime give_up = ros::SteadyTime::now() + ros::WallDuration(30.0);
  while (report.latencies.count() == 0) {
    if (!ros::ok() || ros::SteadyTime::now() > give_up) {
      throw std::runtime_error(node_.resolveName("haptic_proxy") +
                               " gives no wrench of organ 'organ' with tool 'tool0'");
    }
    send_pose(ros::Time::now());
    answer_until(ros::Time::now() + ros::Duration(0.1), queue_);
  }
  waiting_.clear();
}

LatencyReport Hand::run(double seconds) {
  LatencyReport report;
  report.rate = kRate;
  report_ = &report;
  const ros::Duration period(1.0 / kRate);
  const auto count = static_cast<std::size_t>(seconds * kRate);
  ros::Time tick = ros::Time::now() + period;
  for (; report.sent < count && ros::ok(); ++report.sent, tick += period) {
    // The answer to the last pose has half a period to arrive before the next shape comes.
    answer_until(tick - period * 0.5, queue_);
    if (++tick_ % shape_period_ == 0) send_shape();
    answer_until(tick, queue_);
    send_pose(tick);
  }
  report.late = ros::Time::now() > tick + period;
  answer_until(ros::Time::now() + kLastAnswers, queue_);
  report.skipped = waiting_.size();
  waiting_.clear();
  return report;
}

void Hand::send_pose(ros::Time stamp) {
  const auto pose = boost::make_shared<geometry_msgs::PoseStamped>();
  pose->header.frame_id = kOrgan;
  pose->header.stamp = stamp;
  pose->pose.position = tf2::toMsg(lap_[tick_ % kLap].axis.tip);
  pose->pose.orientation.w = 1.0;
  waiting_[stamp.toNSec()] = ros::SteadyTime::now();
  poses_.publish(pose);
}

void Hand::send_shape() {
  const auto shape = boost::make_shared<OrganVertices>();
  shape->header.frame_id = kOrgan;
  shape->header.stamp = ros::Time::now();
  shape->organ = kOrgan;
  shape->vertices = *organ_.shape(tick_);
  vertices_.publish(shape);
}

/// A wrench without a force counts as failed, because tissue always holds this hand.
void Hand::on_wrench(const geometry_msgs::WrenchStampedConstPtr& wrench) {
  const auto sent = waiting_.find(wrench->header.stamp.toNSec());
  if (sent == waiting_.end()) return;
  report_->latencies.add((ros::SteadyTime::now() - sent->second).toSec());
  const geometry_msgs::Vector3& force = wrench->wrench.force;
  report_->failed += force.x == 0.0 && force.y == 0.0 && force.z == 0.0;
  waiting_.erase(sent);
}

}  // namespace organ_collision::bench

// pose_to_wrench external|nodelet|echo FACES SECONDS
// Measures the node haptic_proxy of its own namespace, which is already running (external), or the
// nodelet or an Echo in this process. Prints a line of JSON: "poses" with the latencies from poses
// to wrenches.
int main(int argc, char** argv) {
  using namespace organ_collision::bench;
  ros::init(argc, argv, "pose_to_wrench");
  if (argc != 4) {
    return std::cerr << "pose_to_wrench external|nodelet|echo FACES SECONDS" << std::endl, 2;
  }
  const std::string what = argv[1];
  const ros::NodeHandle node;
  try {
    std::unique_ptr<nodelet::Loader> loader;
    std::optional<Echo> echo;
    if (what == "echo") echo.emplace(1);
    if (what == "nodelet") {
      loader = std::make_unique<nodelet::Loader>(false);
      const std::string name = ros::names::resolve("haptic_proxy");
      if (!loader->load(name, "organ_collision/HapticProxyNodelet", {}, {})) return 1;
    }
    Hand hand(std::strtoul(argv[2], nullptr, 10));
    hand.start();
    hand.run(1.0);
    print("poses", hand.run(std::atof(argv[3])));
  } catch (const std::exception& error) {
    std::cerr << "pose_to_wrench: " << error.what() << std::endl;
    return 1;
  }
}
