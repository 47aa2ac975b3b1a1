#pragma once

namespace organ_collision {

/// The interval that a shape covers along a direction: the least and the greatest value of
/// direction · point over its points. In metres if the direction is a unit vector.
struct ProjectionInterval {
  double low;   ///< the least value
  double high;  ///< the greatest value
};

}  // namespace organ_collision
