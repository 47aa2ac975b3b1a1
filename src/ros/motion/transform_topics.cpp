#include "transform_topics.hpp"

#include <chrono>
#include <stdexcept>

#include "geometry/concatenate.hpp"
#include "ros/interface/checked_messages.hpp"

namespace organ_collision {
namespace {

/// [messages] If more messages wait, the oldest are dropped, and the sweep connects the poses of
/// the others directly.
constexpr std::uint32_t kQueue = 1000;

/// What tf2 may have refused: a parent, a stamp, or numbers.
std::string contents(const geometry_msgs::TransformStamped& transform) {
  const auto& p = transform.transform.translation;
  const auto& q = transform.transform.rotation;
  return concatenate("tf2 does not take it, with the parent '", transform.header.frame_id,
                     "', the stamp ", transform.header.stamp, ", the translation (", p.x, ", ", p.y,
                     ", ", p.z, ") and the rotation (", q.x, ", ", q.y, ", ", q.z, ", ", q.w, ")");
}

}  // namespace

void TransformTopics::subscribe(ros::NodeHandle node) {
  const auto subscribe_to = [&](const std::string& topic, bool resting) {
    subscribers_.push_back(subscribe_checked<tf2_msgs::TFMessage>(
        node, topic, kQueue,
        [this, resting](const auto& event) {
          take(*event.getConstMessage(), event.getPublisherName(), resting);
        },
        rejected_));
  };
  subscribe_to("/tf", false);
  subscribe_to("/tf_static", true);
}

void TransformTopics::take(const tf2_msgs::TFMessage& message, const std::string& authority,
                           bool resting) {
  const ros::Time now = ros::Time::now();
  for (const geometry_msgs::TransformStamped& transform : message.transforms) {
    const std::string ahead =
        resting ? "" : ahead_fault(transform.header.stamp, now, max_ahead_sec_);
    if (!ahead.empty()) {
      reject(transform, ahead);
      continue;
    }
    try {
      if (buffer_.add(transform, authority, resting)) continue;
      const bool is_repeated =
          !resting && buffer_.has(transform.child_frame_id, transform.header.stamp);
      if (!is_repeated) reject(transform, contents(transform));
    } catch (const std::runtime_error& error) {
      reject(transform, error.what());
    }
  }
}

void TransformTopics::reject(const geometry_msgs::TransformStamped& transform,
                             const std::string& why) {
  rejected_.add("transform", "transform of '" + transform.child_frame_id + "': " + why,
                std::chrono::steady_clock::now());
}

}  // namespace organ_collision
