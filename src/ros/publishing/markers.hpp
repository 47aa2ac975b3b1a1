#pragma once

#include <visualization_msgs/MarkerArray.h>

#include "ros/steps/step_scheduler.hpp"

namespace organ_collision {

/// The markers of a step for RViz, in the organ's frame: the tool's shaft, the surface that its
/// axis swept, the faces that the tool touched, and their regions if the answer has them. The
/// markers of the next step replace them. Links have no markers, because RViz's RobotModel shows
/// them.
visualization_msgs::MarkerArray step_markers(const EvaluatedStep& step);

}  // namespace organ_collision
