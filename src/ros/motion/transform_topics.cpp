#include "transform_topics.hpp"

#include <chrono>
#include <stdexcept>

namespace organ_collision {
namespace {

/// [messages] If more messages wait, the oldest are dropped, and the sweep connects the poses of
/// the others directly.
constexpr std::uint32_t kQueue = 1000;

}  // namespace

void TransformTopics::subscribe(ros::NodeHandle node) {
  using Event = ros::MessageEvent<tf2_msgs::TFMessage const>;
  const auto subscribe_to = [&](const std::string& topic, bool resting) {
    const boost::function<void(const Event&)> callback = [this, resting](const Event& event) {
      take(*event.getConstMessage(), event.getPublisherName(), resting);
    };
    subscribers_.push_back(node.subscribe<tf2_msgs::TFMessage>(topic, kQueue, callback, {},
                                                               ros::TransportHints().tcpNoDelay()));
  };
  subscribe_to("/tf", false);
  subscribe_to("/tf_static", true);
}

void TransformTopics::take(const tf2_msgs::TFMessage& message, const std::string& authority,
                           bool resting) {
  for (const geometry_msgs::TransformStamped& transform : message.transforms) {
    try {
      buffer_.add(transform, authority, resting);
    } catch (const std::runtime_error& error) {
      rejected_.add("transform", "transform of '" + transform.child_frame_id + "': " + error.what(),
                    std::chrono::steady_clock::now());
    }
  }
}

}  // namespace organ_collision
