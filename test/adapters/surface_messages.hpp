#pragma once

#include <gtest/gtest.h>
#include <sensor_msgs/PointCloud2.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "adapters/surface_messages.hpp"
#include "test/refusals.hpp"

namespace organ_collision {

/// The reason and message with which a call refuses, as "reason: message".
template <typename Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const MessageError& error) {
    return error.reason() + ": " + error.what();
  }
  return "accepted";
}

/// The layout of a cloud's data: the fields of a point, in this order.
struct CloudLayout {
  struct Field {
    std::string name;  ///< empty: padding
    std::uint8_t datatype = sensor_msgs::PointField::FLOAT32;
  };
  std::vector<Field> fields;
  bool big_endian = false;
  std::uint32_t width = 0;        ///< 0: all points in one row
  std::uint32_t row_padding = 0;  ///< [bytes]
};

inline const CloudLayout kPackedFloats{{{"x"}, {"y"}, {"z"}}};

inline std::uint32_t size_of(std::uint8_t datatype) {
  constexpr std::uint32_t kSizes[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[datatype];
}

template <typename Number>
void append_number(Number number, bool big_endian, std::vector<std::uint8_t>& data) {
  std::uint8_t bytes[sizeof(Number)];
  std::memcpy(bytes, &number, sizeof(Number));
  const bool host_is_big_endian = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;
  if (big_endian != host_is_big_endian) std::reverse(bytes, bytes + sizeof(Number));
  data.insert(data.end(), bytes, bytes + sizeof(Number));
}

/// A cloud of the points x y z x y z ... in that layout. The other bytes are noise.
inline sensor_msgs::PointCloud2 cloud_of(const std::vector<double>& points,
                                         const CloudLayout& layout = kPackedFloats) {
  using sensor_msgs::PointField;
  sensor_msgs::PointCloud2 cloud;
  cloud.is_bigendian = layout.big_endian;
  for (const CloudLayout::Field& field : layout.fields) {
    if (!field.name.empty()) {
      PointField message;
      message.name = field.name;
      message.offset = cloud.point_step;
      message.datatype = field.datatype;
      message.count = 1;
      cloud.fields.push_back(message);
    }
    cloud.point_step += size_of(field.datatype);
  }
  const auto count = static_cast<std::uint32_t>(points.size() / 3);
  if (count == 0) return cloud;
  cloud.width = layout.width == 0 ? count : layout.width;
  cloud.height = count / cloud.width;
  cloud.row_step = cloud.width * cloud.point_step + layout.row_padding;
  for (std::size_t point = 0; point < count; ++point) {
    for (const CloudLayout::Field& field : layout.fields) {
      const std::size_t axis = std::string("xyz").find(field.name);
      if (field.name.size() != 1 || axis == std::string::npos) {
        cloud.data.insert(cloud.data.end(), size_of(field.datatype), 0xA5);
      } else if (field.datatype == PointField::FLOAT64) {
        append_number(points[3 * point + axis], layout.big_endian, cloud.data);
      } else {
        append_number(static_cast<float>(points[3 * point + axis]), layout.big_endian, cloud.data);
      }
    }
    const bool ends_row = (point + 1) % cloud.width == 0;
    if (ends_row) cloud.data.insert(cloud.data.end(), layout.row_padding, 0x5A);
  }
  return cloud;
}

}  // namespace organ_collision
