#include "moving_tools.hpp"

#include <ros/time.h>

#include <boost/make_shared.hpp>

#include "test/rostest/load/tool_messages.hpp"

namespace organ_collision::stress {
namespace {

constexpr double kPhaseStep = 0.01;  // [rad] from pose to pose

}  // namespace

MovingTools::MovingTools() : stylus_(node_.advertise<geometry_msgs::PoseStamped>("/stylus", 10)) {
  static_transforms_.sendTransform(resting_transforms(ros::Time::now()));
}

void MovingTools::send() {
  phase_ += kPhaseStep;
  const ToolPlaces places = tool_places(phase_);
  transforms_.sendTransform(moving_transforms(places, ros::Time::now()));
  stylus_.publish(
      boost::make_shared<geometry_msgs::PoseStamped>(stylus_pose(places, ros::Time::now())));
}

}  // namespace organ_collision::stress
