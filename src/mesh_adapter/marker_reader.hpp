#pragma once

#include <visualization_msgs/Marker.h>

#include <string>

#include "surface.hpp"

namespace organ_collision {

/// Reads the one marker of a topic that is an organ: a TRIANGLE_LIST, three vertices a face, placed
/// by its scale and pose. The first one that is kept is it, by namespace and id, until it is
/// deleted.
class MarkerReader {
 public:
  /// Replaces what `surface` held; empty after DELETE or DELETEALL. An orientation of four zeros is
  /// none, as in RViz. Throws MessageError, also for each other marker.
  void read(const visualization_msgs::Marker& marker, Surface& surface);
  /// What was read last is accepted: it was, or is no more, the organ's.
  void keep() { name_ = read_name_; }

 private:
  void check_name(const std::string& name) const;

  std::string name_;  ///< "namespace/id" of the organ's marker; empty: none so far
  std::string read_name_;
};

}  // namespace organ_collision
