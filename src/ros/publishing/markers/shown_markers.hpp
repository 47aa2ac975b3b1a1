#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <map>
#include <string>

namespace organ_collision {

/// Which markers the subscribers have, so that what is no longer there can be deleted.
class ShownMarkers {
 public:
  /// The number of markers that a namespace has now, with the ids 0 ... count - 1.
  struct Group {
    int count = 0;
    std::string frame = {};  ///< of one of them; RViz ignores a DELETE without a frame
  };
  using Groups = std::map<std::string, Group>;

  /// Notes that `now` is all that subscribers are to have. Adds a DELETE to `array` for each marker
  /// that they have beyond that.
  void replace(Groups now, visualization_msgs::MarkerArray& array);
  /// Notes that the subscribers have nothing.
  void clear() { groups_.clear(); }

 private:
  Groups groups_;
};

}  // namespace organ_collision
