#include "marker_topic.hpp"

#include <chrono>
#include <exception>
#include <utility>

#include "organ_collision/ros/names.hpp"
#include "ros/interface/thread_scheduling.hpp"

namespace organ_collision {
namespace {

/// [messages] For each subscriber. A surface of two million faces has 977.
constexpr std::uint32_t kQueue = 1200;
/// After each message, so that roscpp's thread, which also receives organs and transforms, is never
/// busy with markers for long.
constexpr std::chrono::microseconds kPause(125);
/// [Hz] If markers are switched off, an empty picture is drawn at this rate. It deletes what is
/// still shown.
constexpr double kEmptyRate = 1.0;

}  // namespace

MarkerTopic::MarkerTopic(ros::NodeHandle private_node) {
  // roscpp calls both through the node's queue, in the node's thread.
  const ros::SubscriberStatusCallback come = [this](const ros::SingleSubscriberPublisher&) {
    ++subscribers_;
    anew_ = true;
  };
  const ros::SubscriberStatusCallback gone = [this](const ros::SingleSubscriberPublisher&) {
    --subscribers_;
  };
  markers_ =
      private_node.advertise<visualization_msgs::MarkerArray>(names::kMarkers, kQueue, come, gone);
  thread_ = std::thread([this] { draw_pictures(); });
}

MarkerTopic::~MarkerTopic() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

bool MarkerTopic::is_due(double rate_hz, SteadyTime now) {
  if (!has_subscribers() || now < due_) return false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (picture_ || drawing_) return false;
  }
  const std::chrono::duration<double> period(1.0 / (rate_hz > 0.0 ? rate_hz : kEmptyRate));
  due_ = now + std::chrono::duration_cast<SteadyTime::duration>(period);
  return true;
}

bool MarkerTopic::take_anew() { return std::exchange(anew_, false); }

void MarkerTopic::draw(Picture picture) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    picture_ = std::move(picture);
  }
  changed_.notify_one();
}

/// The drawing thread.
void MarkerTopic::draw_pictures() {
  lower_priority_of_this_thread();
  while (const Picture picture = next_picture()) {
    try {
      picture([this](const auto& array) { publish(array); });
    } catch (const std::exception&) {  // Usually std::bad_alloc: this picture is left out.
    }
  }
}

/// Waits for the next picture. Empty: the end.
MarkerTopic::Picture MarkerTopic::next_picture() {
  std::unique_lock<std::mutex> lock(mutex_);
  drawing_ = false;
  changed_.wait(lock, [this] { return stop_ || picture_; });
  if (stop_) return {};
  drawing_ = true;
  return std::exchange(picture_, {});
}

void MarkerTopic::publish(const visualization_msgs::MarkerArrayConstPtr& array) {
  markers_.publish(array);
  std::this_thread::sleep_for(kPause);
}

}  // namespace organ_collision
