#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <vector>

namespace organ_collision {

/// Replaces the content of `vertices` by the fields x, y and z of all points, row by row, as
/// x y z x y z ... The fields may lie anywhere in a point and in any order. They may be float32 or
/// float64, in little or big endian. Other fields and padding are skipped. The numbers are rounded
/// to 32-bit floats and need not be finite. Throws MessageError.
void read_points(const sensor_msgs::PointCloud2& cloud, std::vector<float>& vertices);

}  // namespace organ_collision
