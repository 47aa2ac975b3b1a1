#include "marker_store.hpp"

#include <iterator>

namespace organ_collision {
namespace {

using visualization_msgs::Marker;

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
      clear(topic);
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

void MarkerStore::clear(const std::string& topic) {
  erase_if(entries_, [&](const auto& entry) { return entry.first.topic == topic; });
}

}  // namespace organ_collision
