// The driver of a haptic device: sends the pose of its stylus to haptic_proxy each millisecond, and
// pushes the hand with the force that comes back. The class Device stands for the library of a
// device; all the rest can stay.
#include <geometry_msgs/PoseStamped.h>
#include <organ_collision/ProxyState.h>
#include <ros/ros.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <Eigen/Geometry>
#include <cmath>
#include <iostream>

using Eigen::Vector3d;
using geometry_msgs::PoseStamped;
using organ_collision::ProxyState;

constexpr double kPeriod = 0.001;  // [s] between two poses
constexpr double kOldest = 0.01;   // [s] If the last state is older, the force is switched off.

// Replace its two functions by calls of your device. Here, a hand dips the stylus into the tissue
// of examples/simulator.py.
class Device {
 public:
  // The place of the stylus's tip in the frame stylus_base [m]. The stylus is upright.
  Vector3d tip() const {
    const double seconds = ros::WallTime::now().toSec();
    return {0.02 * std::sin(0.7 * seconds), 0.01, 0.01 + 0.015 * std::cos(2.0 * seconds)};
  }

  // What the motors apply to the hand: a force at the tip [N], and a torque about it [N m], which
  // most devices cannot give.
  void push(const Vector3d& force, const Vector3d& /*torque*/) {
    ROS_INFO_THROTTLE(1.0, "the force on the hand is (%.2f, %.2f, %.2f) N", force.x(), force.y(),
                      force.z());
  }
};

// A transform without rotation; z in metres.
geometry_msgs::TransformStamped frame(const char* parent, const char* name, double z) {
  geometry_msgs::TransformStamped frame;
  frame.header.stamp = ros::Time::now();
  frame.header.frame_id = parent;
  frame.child_frame_id = name;
  frame.transform.translation.z = z;
  frame.transform.rotation.w = 1.0;
  return frame;
}

class Driver {
 public:
  Driver()
      : poses_(node_.advertise<PoseStamped>("stylus/pose", 1)),
        // Without tcpNoDelay, the socket may keep a state back for tens of milliseconds.
        states_(node_.subscribe("haptic_proxy/stylus/state", 1, &Driver::apply, this,
                                ros::TransportHints().tcpNoDelay())),
        timer_(node_.createWallTimer(ros::WallDuration(kPeriod), &Driver::send, this)) {
    // Where the device stands in the scene, and where the stylus ends. They never move.
    frames_.sendTransform(
        {frame("tissue", "stylus_base", 0.0), frame("stylus_tip", "stylus_handle", 0.1)});
  }

 private:
  void send(const ros::WallTimerEvent& /*event*/) {
    const Vector3d tip = device_.tip();
    PoseStamped pose;
    pose.header.stamp = ros::Time::now();
    pose.header.frame_id = "stylus_base";
    pose.pose.position.x = tip.x();
    pose.pose.position.y = tip.y();
    pose.pose.position.z = tip.z();
    pose.pose.orientation.w = 1.0;
    poses_.publish(pose);
    // Nobody else watches whether haptic_proxy, or the way to it, still works.
    if (ros::Time::now().toSec() - last_state_.toSec() > kOldest) {
      device_.push(Vector3d::Zero(), Vector3d::Zero());
      ROS_WARN_THROTTLE(1.0, "the last state is too old: the force is off");
    }
  }

  // haptic_proxy fades the force itself if it has no answer.
  void apply(const ProxyState& state) {
    last_state_ = state.header.stamp;
    const Vector3d tip(state.hand.position.x, state.hand.position.y, state.hand.position.z);
    const auto& wrench = state.wrench;
    const Vector3d force(wrench.force.x, wrench.force.y, wrench.force.z);
    const Vector3d torque(wrench.torque.x, wrench.torque.y, wrench.torque.z);
    // The torque of the state is about the origin of stylus_base.
    device_.push(force, torque - tip.cross(force));
    if (state.state == ProxyState::NO_ANSWER) ROS_WARN_THROTTLE(1.0, "%s", state.message.c_str());
  }

  ros::NodeHandle node_;
  Device device_;
  ros::Time last_state_;
  tf2_ros::StaticTransformBroadcaster frames_;
  ros::Publisher poses_;
  ros::Subscriber states_;
  ros::WallTimer timer_;
};

constexpr char kUsage[] = R"(Usage: stylus_driver
Stands for the driver of a haptic device whose tool is called stylus (examples/haptics.launch).
Publishes stylus/pose and /tf_static. Subscribes to haptic_proxy/stylus/state, and logs the force.
)";

int main(int argc, char** argv) {
  ros::V_string arguments;
  ros::removeROSArgs(argc, argv, arguments);
  if (arguments.size() > 1) {
    std::cout << kUsage;
    return arguments[1] == "--help" || arguments[1] == "-h" ? 0 : 2;
  }
  ros::init(argc, argv, "stylus_driver");
  Driver driver;
  ros::spin();
}
