#pragma once

#include <pcl_msgs/PolygonMesh.h>
#include <ros/time.h>
#include <sensor_msgs/PointCloud2.h>
#include <shape_msgs/Mesh.h>
#include <visualization_msgs/Marker.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "geometry/concatenate.hpp"

namespace organ_collision {

/// An organ's surface as a message described it. It may be illegal: the collision node checks it.
struct ReceivedSurface {
  std::string frame;                     ///< empty: the message has none
  ros::Time stamp;                       ///< zero: the message has none
  std::vector<float> vertices;           ///< x y z x y z ... [m]
  std::vector<std::uint32_t> triangles;  ///< three vertex indices for each face

  /// Whether the surface is empty, which means that the organ was removed.
  bool empty() const { return vertices.empty() && triangles.empty(); }
};

/// A message that cannot be read as a surface. what() names the illegal value and what is legal.
class MessageError : public std::runtime_error {
 public:
  /// `reason`: a short text that is the same for all errors of one kind. Errors are counted by
  /// reason. `parts` make up the text of what().
  template <typename... Parts>
  explicit MessageError(const char* reason, const Parts&... parts)
      : std::runtime_error(concatenate(parts...)), reason_(reason) {}

  const std::string& reason() const { return reason_; }

 private:
  std::string reason_;
};

/// The coordinate of a vertex along an axis (0: x) as a 32-bit float. Throws MessageError if it is
/// NaN, infinite, or too large for a float.
float coordinate(double value, std::size_t vertex, std::size_t axis);

/// The fields x, y and z of all points, row by row, as x y z x y z ... The fields may lie anywhere
/// in a point and in any order. They may be float32 or float64, in little or big endian. Other
/// fields and padding are skipped. The numbers are rounded to 32-bit floats. Throws MessageError.
std::vector<float> read_points(const sensor_msgs::PointCloud2& cloud);

// Conversions from messages with a mesh to surfaces. Vertices keep their order and are rounded to
// 32-bit floats. What is not finite as such a float is refused here, because only here it is known
// what the message had.

/// The surface has no frame and no stamp, because the message has none. Throws MessageError.
ReceivedSurface convert(const shape_msgs::Mesh& mesh);

/// A polygon of n corners is cut into a fan around its first corner and becomes n - 2 faces. If the
/// mesh's own header has no frame or no stamp, the one in the cloud's header is used. Throws
/// MessageError.
ReceivedSurface convert(const pcl_msgs::PolygonMesh& mesh);

/// Reads the organ's marker among the markers of a topic: a TRIANGLE_LIST with three vertices for
/// each face, placed by its scale and pose. The organ's marker is identified by namespace and id.
/// The first marker that is kept becomes the organ's marker, until it is deleted.
class MarkerReader {
 public:
  /// The actions DELETE and DELETEALL give an empty surface. An orientation of four zeros means no
  /// rotation, as in RViz. Throws MessageError, also if the marker is not the organ's.
  ReceivedSurface read(const visualization_msgs::Marker& marker);
  /// Accepts the marker that was read last as the organ's. If it deleted the organ's marker, the
  /// next marker that is kept becomes the organ's.
  void keep() { name_ = read_name_; }

 private:
  std::string name_;       ///< "namespace/id" of the organ's marker; empty: none yet
  std::string read_name_;  ///< name of the marker read last; empty: it deleted the organ's
};

}  // namespace organ_collision
