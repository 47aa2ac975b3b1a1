#include "moving_tools.hpp"

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <ros/time.h>

#include <boost/make_shared.hpp>
#include <cmath>
#include <string>
#include <vector>

namespace organ_collision::stress {
namespace {

constexpr double kPhaseStep = 0.01;     // [rad] from pose to pose
constexpr double kReach = 0.01;         // [m] above and below the sheets
constexpr double kTrocarHeight = 0.15;  // [m]

geometry_msgs::TransformStamped transform(const std::string& frame, double x, double y, double z) {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = "sheet";
  transform.header.stamp = ros::Time::now();
  transform.child_frame_id = frame;
  transform.transform.translation.x = x;
  transform.transform.translation.y = y;
  transform.transform.translation.z = z;
  transform.transform.rotation.w = 1.0;
  return transform;
}

}  // namespace

MovingTools::MovingTools() : stylus_(node_.advertise<geometry_msgs::PoseStamped>("/stylus", 10)) {
  static_transforms_.sendTransform(std::vector<geometry_msgs::TransformStamped>{
      transform("probe_trocar", 0.02, 0.01, kTrocarHeight),
      transform("needle_trocar", -0.02, 0.01, kTrocarHeight),
      transform("stylus_trocar", 0.01, -0.02, kTrocarHeight)});
}

void MovingTools::send() {
  phase_ += kPhaseStep;
  const double height = kReach * std::sin(phase_), side = kReach * std::cos(0.3 * phase_);
  transforms_.sendTransform(std::vector<geometry_msgs::TransformStamped>{
      transform("probe_tip", side, 0.0, height), transform("needle_tip", 0.0, side, -height),
      transform("jaw", side, side, height)});
  const auto pose = boost::make_shared<geometry_msgs::PoseStamped>();
  pose->header.frame_id = "sheet";
  pose->header.stamp = ros::Time::now();
  pose->pose.position.x = -side;
  pose->pose.position.z = height;
  pose->pose.orientation.w = 1.0;
  stylus_.publish(pose);
}

}  // namespace organ_collision::stress
