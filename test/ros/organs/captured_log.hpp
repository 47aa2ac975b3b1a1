#pragma once

#include <ros/console.h>

#include <string>
#include <utility>
#include <vector>

namespace organ_collision {

/// Everything that is logged at level INFO or above in its lifetime. There is one at a time.
class CapturedLog : ros::console::LogAppender {
 public:
  CapturedLog() {
    ros::console::initialize();
    ros::console::register_appender(this);
  }
  ~CapturedLog() override { ros::console::deregister_appender(this); }

  /// What has been logged since the last call, each with its level: "WARN the text".
  std::vector<std::string> take() { return std::exchange(lines_, {}); }

 private:
  void log(ros::console::Level level, const char* text, const char*, const char*, int) override {
    const char* const levels[] = {"DEBUG ", "INFO ", "WARN ", "ERROR ", "FATAL "};
    if (level >= ros::console::levels::Info) lines_.push_back(levels[level] + std::string(text));
  }

  std::vector<std::string> lines_;
};

}  // namespace organ_collision
