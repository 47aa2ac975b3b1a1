#include "markers.hpp"

#include <iterator>

namespace organ_collision {

using visualization_msgs::Marker;

template <typename Condition>
void MarkerStore::erase_if(Condition condition) {
  for (auto entry = entries_.begin(); entry != entries_.end();) {
    entry = condition(*entry) ? entries_.erase(entry) : std::next(entry);
  }
}

void MarkerStore::apply(const std::string& topic, const visualization_msgs::MarkerArray& message,
                        const ros::Time& now) {
  for (const Marker& marker : message.markers) {
    const Key key{topic, marker.ns, marker.id};
    if (marker.action == Marker::ADD) {  // which also means MODIFY
      entries_[key] = {marker, now, std::nullopt};
    } else if (marker.action == Marker::DELETE) {
      entries_.erase(key);
    } else if (marker.action == Marker::DELETEALL) {
      erase_if([&](const auto& entry) { return std::get<0>(entry.first) == topic; });
    }
  }
}

void MarkerStore::expire(const ros::Time& now) {
  erase_if([&](const auto& entry) {
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

}  // namespace organ_collision
