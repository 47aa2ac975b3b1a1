#pragma once

#include <visualization_msgs/Marker.h>

#include <string>

#include "received_surface.hpp"

namespace organ_collision {

/// Reads the organ's marker among the markers of a topic: a TRIANGLE_LIST with three vertices for
/// each face, placed by its scale and pose. The organ's marker is identified by namespace and id.
/// The first marker that is kept becomes the organ's marker, until it is deleted.
class MarkerReader {
 public:
  /// Replaces the content of `surface`; DELETE and DELETEALL make it empty. An orientation of four
  /// zeros means no rotation, as in RViz. Throws MessageError, also if the marker is not the
  /// organ's.
  void read(const visualization_msgs::Marker& marker, ReceivedSurface& surface);
  /// Accepts the marker that was read last as the organ's. If it deleted the organ's marker, the
  /// next marker that is kept becomes the organ's.
  void keep() { name_ = read_name_; }

 private:
  void check_name(const std::string& name) const;

  std::string name_;       ///< "namespace/id" of the organ's marker; empty: none yet
  std::string read_name_;  ///< name of the marker read last; empty: it deleted the organ's
};

}  // namespace organ_collision
