#include "markers.hpp"

#include <ros/callback_queue.h>

#include <algorithm>
#include <iterator>

#include "ros/messages/conversions.hpp"

namespace organ_collision {
namespace {

using visualization_msgs::Marker;

constexpr double kUpdateSec = 0.01;
constexpr std::uint32_t kQueueSize = 4000;

template <typename Map, typename Condition>
void erase_if(Map& map, Condition condition) {
  for (auto entry = map.begin(); entry != map.end();) {
    entry = condition(*entry) ? map.erase(entry) : std::next(entry);
  }
}

}  // namespace

void MarkerStore::apply(const std::string& topic, const visualization_msgs::MarkerArray& message,
                        const ros::Time& now) {
  for (const Marker& marker : message.markers) {
    const Key key{topic, marker.ns, marker.id};
    if (marker.action == Marker::ADD) {  // which also means MODIFY
      entries_[key] = {marker, now, std::nullopt};
    } else if (marker.action == Marker::DELETE) {
      entries_.erase(key);
    } else if (marker.action == Marker::DELETEALL) {
      erase_if(entries_, [&](const auto& entry) { return entry.first.topic == topic; });
    }
  }
}

void MarkerStore::expire(const ros::Time& now) {
  erase_if(entries_, [&](const auto& entry) {
    const ros::Duration lifetime = entry.second.marker.lifetime;  // 0: for ever
    return lifetime > ros::Duration(0.0) && now - entry.second.received >= lifetime;
  });
}

void MarkerStore::place(const Lookup& lookup) {
  for (auto& [key, entry] : entries_) {
    const bool locked = entry.marker.frame_locked != 0;
    if (entry.T_fixed_header && !locked) continue;
    const std_msgs::Header& header = entry.marker.header;
    const auto found = lookup(header.frame_id, locked ? ros::Time() : header.stamp);
    if (found) entry.T_fixed_header = found;
  }
}

MarkerListener::MarkerListener(const std::vector<std::string>& topics, const std::string& frame)
    : frame_(tf_frame(frame)), listener_(buffer_) {
  ros::NodeHandle node;
  for (const std::string& topic : topics) {
    subscribers_.push_back(node.subscribe<visualization_msgs::MarkerArray>(
        topic, kQueueSize, [this, topic](const visualization_msgs::MarkerArrayConstPtr& message) {
          receive(topic, *message);
        }));
  }
}

void MarkerListener::update() {
  ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(kUpdateSec));
  markers_.expire(ros::Time::now());
  missing_transforms_.clear();
  markers_.place(
      [this](const std::string& frame, const ros::Time& stamp) { return look_up(frame, stamp); });
}

bool MarkerListener::has_placed_marker() const {
  const auto& entries = markers_.entries();
  return std::any_of(entries.begin(), entries.end(),
                     [](const auto& entry) { return entry.second.T_fixed_header.has_value(); });
}

bool MarkerListener::has_publisher() const {
  return std::any_of(
      subscribers_.begin(), subscribers_.end(),
      [](const ros::Subscriber& subscriber) { return subscriber.getNumPublishers() > 0; });
}

void MarkerListener::receive(const std::string& topic,
                             const visualization_msgs::MarkerArray& message) {
  markers_.apply(topic, message, ros::Time::now());
  if (frame_.empty() && !markers_.entries().empty()) {
    frame_ = tf_frame(markers_.entries().begin()->second.marker.header.frame_id);
  }
}

std::optional<Eigen::Isometry3d> MarkerListener::look_up(const std::string& frame,
                                                         const ros::Time& stamp) {
  if (tf_frame(frame) == frame_) return Eigen::Isometry3d::Identity();
  try {
    return to_eigen(buffer_.lookupTransform(frame_, tf_frame(frame), stamp).transform);
  } catch (const tf2::TransformException& error) {
    missing_transforms_[frame] = error.what();
    return std::nullopt;
  }
}

}  // namespace organ_collision
