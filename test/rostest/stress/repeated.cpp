#include "repeated.hpp"

#include <ros/duration.h>

#include <utility>

namespace organ_collision::stress {

Repeated::Repeated(double pause, std::function<void()> once)
    : once_(std::move(once)), thread_([this, pause] { work(pause); }) {}

Repeated::~Repeated() {
  stop_ = true;
  thread_.join();
}

void Repeated::work(double pause) const {
  while (!stop_) {
    once_();
    ros::WallDuration(pause).sleep();
  }
}

}  // namespace organ_collision::stress
