#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <vector>

namespace organ_collision {

/// The fields x, y and z of all points as x y z x y z ..., row by row, in place of what `vertices`
/// held. The fields may stand anywhere in a point, in any order, as float32 or float64, little or
/// big endian; other fields and padding are skipped. Numbers are rounded to 32-bit floats, and need
/// not be finite. Throws MessageError.
void read_points(const sensor_msgs::PointCloud2& cloud, std::vector<float>& vertices);

}  // namespace organ_collision
