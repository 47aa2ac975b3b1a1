#pragma once

namespace organ_collision {

/// What a shape covers along a direction: the least and the greatest direction · point of its
/// points. In metres if the direction is unit.
struct ProjectionInterval {
  double low;   ///< the least
  double high;  ///< the greatest
};

}  // namespace organ_collision
