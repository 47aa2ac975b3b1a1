#include "surface_messages.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <boost/endian/conversion.hpp>
#include <cmath>
#include <numeric>

#include "common/messages/conversions.hpp"
#include "common/messages/text.hpp"

namespace organ_collision {
namespace {

using boost::endian::order;
using sensor_msgs::PointCloud2;
using sensor_msgs::PointField;
using visualization_msgs::Marker;

/// [1] The norm of a legal orientation differs from 1 by at most this.
constexpr double kUnitTolerance = 1e-2;

std::size_t size_of(const PointField& field) {
  return field.datatype == PointField::FLOAT64 ? sizeof(double) : sizeof(float);
}

/// The field with this name. Throws MessageError if there is none, if its type or its count is
/// illegal, or if it ends beyond the point.
const PointField& field_of(const PointCloud2& cloud, const std::string& name) {
  const auto field = std::find_if(cloud.fields.begin(), cloud.fields.end(),
                                  [&](const PointField& field) { return field.name == name; });
  if (field == cloud.fields.end()) {
    std::vector<std::string> names;
    for (const PointField& other : cloud.fields) names.push_back(other.name);
    throw MessageError("missing field", "the fields of the points are '", listed(names),
                       "'; must hold x, y and z");
  }
  if (field->datatype != PointField::FLOAT32 && field->datatype != PointField::FLOAT64) {
    throw MessageError("wrong field type", "field ", name, " has datatype ", int{field->datatype},
                       "; must be 7 (float32) or 8 (float64)");
  }
  if (field->count > 1) {  // Old PCL versions write 0 instead of 1.
    throw MessageError("wrong field count", "field ", name, " has count ", field->count,
                       "; must be 1");
  }
  const std::size_t end = std::size_t{field->offset} + size_of(*field);
  if (end > cloud.point_step) {
    throw MessageError("wrong point_step", "field ", name, " ends at byte ", end,
                       " of a point; point_step is ", cloud.point_step, ", must be at least that");
  }
  return *field;
}

/// Refuses a cloud whose points do not all lie within `data`. Bytes after the last point are
/// ignored. The product of two 32-bit numbers fits 64 bits, but a sum of products may not.
/// Therefore the last row and the earlier rows are compared one after the other.
void check_sizes(const PointCloud2& cloud) {
  const std::uint64_t row = std::uint64_t{cloud.width} * cloud.point_step;
  if (cloud.height > 1 && cloud.row_step < row) {
    throw MessageError("wrong row_step", "row_step is ", cloud.row_step, "; ", cloud.width,
                       " points of point_step ", cloud.point_step, " need ", row);
  }
  const std::uint64_t size = cloud.data.size();
  const std::uint64_t earlier_rows = std::uint64_t{cloud.height - 1} * cloud.row_step;
  if (row > size || (cloud.height > 1 && earlier_rows > size - row)) {
    throw MessageError("truncated cloud", "data has ", size, " bytes; too few for ", cloud.width,
                       " x ", cloud.height, " points of point_step ", cloud.point_step);
  }
}

/// Refuses the coordinate of a vertex along an axis (0: x).
[[noreturn]] void refuse(double value, std::size_t vertex, std::size_t axis) {
  throw MessageError("not finite", "xyz"[axis], " of vertex ", vertex, " is ", value,
                     "; coordinates must be finite 32-bit floats, in metres");
}

/// Copies one field of all points to an axis of the vertices.
template <typename Number, order kOrder>
void copy(const PointCloud2& cloud, std::size_t offset, std::size_t axis,
          std::vector<float>& vertices) {
  std::size_t vertex = 0;
  for (std::size_t row = 0; row < cloud.height; ++row) {
    const std::uint8_t* from = cloud.data.data() + row * cloud.row_step + offset;
    for (std::size_t column = 0; column < cloud.width; ++column, ++vertex) {
      const Number value = boost::endian::endian_load<Number, sizeof(Number), kOrder>(
          from + column * cloud.point_step);
      vertices[3 * vertex + axis] = coordinate(value, vertex, axis);
    }
  }
}

std::string type_name(int type) {
  constexpr std::array<const char*, 12> kNames = {
      "ARROW",     "CUBE",        "SPHERE", "CYLINDER",         "LINE_STRIP",    "LINE_LIST",
      "CUBE_LIST", "SPHERE_LIST", "POINTS", "TEXT_VIEW_FACING", "MESH_RESOURCE", "TRIANGLE_LIST"};
  const bool known = type >= 0 && type < static_cast<int>(kNames.size());
  return std::to_string(type) + " (" + (known ? kNames[type] : "unknown") + ")";
}

/// Refuses zero and negative scales: they would make the organ flat or turn it inside out.
Eigen::Vector3d scale_of(const Marker& marker) {
  Eigen::Vector3d scale = to_eigen(marker.scale);
  if (!scale.allFinite() || scale.minCoeff() <= 0.0) {
    throw MessageError("wrong scale", "scale is ", scale.transpose(),
                       "; must be finite and more than 0");
  }
  return scale;
}

Eigen::Isometry3d pose_of(const Marker& marker) {
  const auto& q = marker.pose.orientation;
  Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
  const double length = rotation.norm();
  if (length == 0.0) {
    rotation.setIdentity();
  } else if (!(std::abs(length - 1.0) <= kUnitTolerance)) {
    throw MessageError("wrong orientation", "pose.orientation has length ", length,
                       "; must be 1, or 0 for none");
  }
  const Eigen::Vector3d position = to_eigen(marker.pose.position);
  if (!position.allFinite()) {
    throw MessageError("not finite", "pose.position is ", position.transpose(),
                       "; must be finite, in metres");
  }
  return Eigen::Translation3d(position) * rotation.normalized();
}

/// The points as x y z x y z ... [m], each moved by a transform. Throws MessageError.
std::vector<float> placed(const std::vector<geometry_msgs::Point>& points,
                          const Eigen::Affine3d& T_frame_points) {
  std::vector<float> vertices;
  vertices.reserve(3 * points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d point = to_eigen(points[i]);
    for (int axis = 0; axis < 3; ++axis) {  // The transform would make all three NaN.
      if (!std::isfinite(point[axis])) refuse(point[axis], i, axis);
    }
    const Eigen::Vector3d vertex = T_frame_points * point;
    for (int axis = 0; axis < 3; ++axis) vertices.push_back(coordinate(vertex[axis], i, axis));
  }
  return vertices;
}

}  // namespace

float coordinate(double value, std::size_t vertex, std::size_t axis) {
  const auto rounded = static_cast<float>(value);
  if (!std::isfinite(rounded)) refuse(value, vertex, axis);
  return rounded;
}

std::vector<float> read_points(const PointCloud2& cloud) {
  if (cloud.width == 0 || cloud.height == 0) {
    if (!cloud.data.empty()) {
      throw MessageError("wrong size", "the cloud is ", cloud.width, " x ", cloud.height,
                         " points; must be none only where data is empty");
    }
    return {};
  }
  const std::array<PointField, 3> fields = {field_of(cloud, "x"), field_of(cloud, "y"),
                                            field_of(cloud, "z")};
  check_sizes(cloud);
  std::vector<float> vertices(3 * std::size_t{cloud.width} * cloud.height);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool is_double = fields[axis].datatype == PointField::FLOAT64;
    const auto copy_axis =
        cloud.is_bigendian != 0
            ? (is_double ? copy<double, order::big> : copy<float, order::big>)
            : (is_double ? copy<double, order::little> : copy<float, order::little>);
    copy_axis(cloud, fields[axis].offset, axis, vertices);
  }
  return vertices;
}

ReceivedSurface convert(const shape_msgs::Mesh& mesh) {
  ReceivedSurface surface;
  surface.vertices = placed(mesh.vertices, Eigen::Affine3d::Identity());
  surface.triangles.reserve(3 * mesh.triangles.size());
  for (const shape_msgs::MeshTriangle& triangle : mesh.triangles) {
    surface.triangles.insert(surface.triangles.end(), triangle.vertex_indices.begin(),
                             triangle.vertex_indices.end());
  }
  return surface;
}

ReceivedSurface convert(const pcl_msgs::PolygonMesh& mesh) {
  const std_msgs::Header &own = mesh.header, &clouds = mesh.cloud.header;
  ReceivedSurface surface{own.frame_id.empty() ? clouds.frame_id : own.frame_id,
                          own.stamp.isZero() ? clouds.stamp : own.stamp,
                          read_points(mesh.cloud),
                          {}};
  for (std::size_t i = 0; i < mesh.polygons.size(); ++i) {
    const auto& corners = mesh.polygons[i].vertices;
    if (corners.size() < 3) {
      throw MessageError("polygon without area", "polygon ", i, " has ", corners.size(),
                         " corners; must have at least 3");
    }
    for (std::size_t last = 2; last < corners.size(); ++last) {
      surface.triangles.insert(surface.triangles.end(),
                               {corners[0], corners[last - 1], corners[last]});
    }
  }
  return surface;
}

ReceivedSurface MarkerReader::read(const Marker& marker) {
  if (const std::string fault = name_fault(marker.ns); !fault.empty()) {
    throw MessageError("illegal name", "the marker's namespace ", fault);
  }
  const std::string name = concatenate(marker.ns, "/", marker.id);
  const bool add = marker.action == Marker::ADD;
  if (!add && marker.action != Marker::DELETE && marker.action != Marker::DELETEALL) {
    throw MessageError("unknown action", "marker '", name, "' has action ", marker.action,
                       "; must be 0 (ADD), 2 (DELETE) or 3 (DELETEALL)");
  }
  if (marker.action != Marker::DELETEALL && !name_.empty() && name != name_) {
    throw MessageError("other marker", "marker '", name, "' is not the organ's, which is '", name_,
                       "'; must have a topic of its own");
  }
  ReceivedSurface surface{marker.header.frame_id, marker.header.stamp, {}, {}};
  if (!add) {
    read_name_.clear();
    return surface;
  }
  if (marker.type != Marker::TRIANGLE_LIST) {
    throw MessageError("other marker type", "marker '", name, "' is of type ",
                       type_name(marker.type), "; must be 11 (TRIANGLE_LIST)");
  }
  if (marker.points.size() % 3 != 0) {
    throw MessageError("wrong number of points", "marker '", name, "' has ", marker.points.size(),
                       " points; must be a multiple of three");
  }
  const Eigen::Isometry3d pose = pose_of(marker);
  surface.vertices = placed(marker.points, pose * Eigen::Scaling(scale_of(marker)));
  surface.triangles.resize(marker.points.size());
  std::iota(surface.triangles.begin(), surface.triangles.end(), 0);
  read_name_ = name;
  return surface;
}

}  // namespace organ_collision
