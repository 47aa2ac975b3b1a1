#pragma once

#include <organ_collision/ContactArray.h>
#include <std_msgs/UInt32MultiArray.h>

namespace organ_collision {

/// The numbers of the touched faces in rising order, each once, in one dimension called "faces".
std_msgs::UInt32MultiArray face_list(const ContactArray& contacts);

}  // namespace organ_collision
