#include <console_bridge/console.h>
#include <ros/console.h>
#include <ros/time.h>

#include "fuzz_input.hpp"

/// Lets the log say nothing, because it would say the same for thousands of inputs, and makes ROS
/// time stand still.
int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  ros::console::set_logger_level(ROSCONSOLE_DEFAULT_NAME, ros::console::levels::Fatal);
  ros::console::notifyLoggerLevelsChanged();
  console_bridge::noOutputHandler();
  ros::Time::init();
  ros::Time::setNow(ros::Time(50));
  return 0;
}
