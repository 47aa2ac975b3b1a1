#pragma once

#include <visualization_msgs/MarkerArray.h>

#include "ros/steps/step_scheduler.hpp"

namespace organ_collision {

/// What RViz shows of a step, in the organ's frame: the tool's shaft, if it has one, the surface
/// that its axis swept, the faces that the tool touched, and their regions where the answer has
/// them. Each is replaced by the next step's. Links are left to RViz's RobotModel.
visualization_msgs::MarkerArray step_markers(const EvaluatedStep& step);

}  // namespace organ_collision
