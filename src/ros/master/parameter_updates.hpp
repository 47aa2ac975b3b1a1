#pragma once

namespace organ_collision {

/// Protects this process from a call `paramUpdate` whose parameter has an illegal name: roscpp
/// throws InvalidNameException in its XML-RPC thread, where nobody catches it, and the process
/// ends. From now on, the caller gets a fault. To be called after ros::init(); further calls do
/// nothing.
void guard_parameter_updates();

}  // namespace organ_collision
