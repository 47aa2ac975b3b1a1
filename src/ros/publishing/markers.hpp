#pragma once

#include <visualization_msgs/MarkerArray.h>

#include "ros/steps/step_scheduler.hpp"

namespace organ_collision {

/// What RViz shows of a step, in the organ's frame: the tool's shaft, the surface that its axis
/// swept, the faces that the tool touched, and their regions if the answer has them. The markers of
/// the next step replace them. RViz's RobotModel shows the links.
visualization_msgs::MarkerArray step_markers(const EvaluatedStep& step);

}  // namespace organ_collision
