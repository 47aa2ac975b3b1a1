#include "point_cloud_reader.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string>

#include "message_error.hpp"
#include "ros/interface/plain_text.hpp"

namespace organ_collision {
namespace {

using sensor_msgs::PointCloud2;
using sensor_msgs::PointField;

constexpr bool kHostIsBigEndian = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;

std::size_t size_of(const PointField& field) {
  return field.datatype == PointField::FLOAT64 ? sizeof(double) : sizeof(float);
}

/// The field with this name. Refuses it if its type is illegal or it lies outside of the point.
const PointField& field_of(const PointCloud2& cloud, const std::string& name) {
  const auto field = std::find_if(cloud.fields.begin(), cloud.fields.end(),
                                  [&](const PointField& field) { return field.name == name; });
  if (field == cloud.fields.end()) {
    std::vector<std::string> names;
    for (const PointField& other : cloud.fields) names.push_back(other.name);
    throw MessageError("missing field", "the fields of the points are '" + listed(names) +
                                            "'; must hold x, y and z");
  }
  if (field->datatype != PointField::FLOAT32 && field->datatype != PointField::FLOAT64) {
    throw MessageError("wrong field type", "field " + name + " has datatype " +
                                               std::to_string(field->datatype) +
                                               "; must be 7 (float32) or 8 (float64)");
  }
  if (field->count > 1) {  // Old PCL versions write 0 for 1.
    throw MessageError("wrong field count", "field " + name + " has count " +
                                                std::to_string(field->count) + "; must be 1");
  }
  const std::size_t end = std::size_t{field->offset} + size_of(*field);
  if (end > cloud.point_step) {
    throw MessageError("wrong point_step", "field " + name + " ends at byte " +
                                               std::to_string(end) + " of a point; point_step is " +
                                               std::to_string(cloud.point_step) +
                                               ", must be at least that");
  }
  return *field;
}

/// Refuses a cloud whose points do not all lie within `data`. Bytes after the last point are
/// ignored. The product of two 32-bit numbers fits 64 bits, but a sum of products may not.
/// Therefore the last row and the earlier rows are compared one after the other.
void check_sizes(const PointCloud2& cloud) {
  const std::uint64_t row = std::uint64_t{cloud.width} * cloud.point_step;
  if (cloud.height > 1 && cloud.row_step < row) {
    throw MessageError("wrong row_step",
                       "row_step is " + std::to_string(cloud.row_step) + "; " +
                           std::to_string(cloud.width) + " points of point_step " +
                           std::to_string(cloud.point_step) + " need " + std::to_string(row));
  }
  const std::uint64_t size = cloud.data.size();
  const std::uint64_t earlier_rows = std::uint64_t{cloud.height - 1} * cloud.row_step;
  if (row > size || (cloud.height > 1 && earlier_rows > size - row)) {
    throw MessageError("truncated cloud",
                       "data has " + std::to_string(size) + " bytes; too few for " +
                           std::to_string(cloud.width) + " x " + std::to_string(cloud.height) +
                           " points of point_step " + std::to_string(cloud.point_step));
  }
}

template <typename Number>
Number number_at(const std::uint8_t* address, bool swap) {
  std::array<std::uint8_t, sizeof(Number)> bytes;
  std::memcpy(bytes.data(), address, sizeof(Number));
  if (swap) std::reverse(bytes.begin(), bytes.end());
  Number number;
  std::memcpy(&number, bytes.data(), sizeof(Number));
  return number;
}

/// Copies one field of all points to to[0], to[3], to[6] ...
template <typename Number>
void copy(const PointCloud2& cloud, std::size_t offset, float* to) {
  const bool swap = (cloud.is_bigendian != 0) != kHostIsBigEndian;
  for (std::size_t row = 0; row < cloud.height; ++row) {
    const std::uint8_t* from = cloud.data.data() + row * cloud.row_step + offset;
    for (std::size_t column = 0; column < cloud.width; ++column, to += 3) {
      *to = static_cast<float>(number_at<Number>(from + column * cloud.point_step, swap));
    }
  }
}

}  // namespace

void read_points(const PointCloud2& cloud, std::vector<float>& vertices) {
  if (cloud.width == 0 || cloud.height == 0) {
    if (!cloud.data.empty()) {
      throw MessageError("wrong size", "the cloud is " + std::to_string(cloud.width) + " x " +
                                           std::to_string(cloud.height) +
                                           " points; must be none only where data is empty");
    }
    return vertices.clear();
  }
  const std::array<PointField, 3> fields = {field_of(cloud, "x"), field_of(cloud, "y"),
                                            field_of(cloud, "z")};
  check_sizes(cloud);
  vertices.resize(3 * std::size_t{cloud.width} * cloud.height);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (fields[axis].datatype == PointField::FLOAT64) {
      copy<double>(cloud, fields[axis].offset, &vertices[axis]);
    } else {
      copy<float>(cloud, fields[axis].offset, &vertices[axis]);
    }
  }
}

}  // namespace organ_collision
