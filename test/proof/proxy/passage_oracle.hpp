#pragma once

#include "organ_collision/geometry/tool/shaft.hpp"
#include "organ_collision/geometry/triangle.hpp"

namespace organ_collision::oracle {

/// Whether a segment comes within `distance` [m] of a face while its ends move linearly, and the
/// face's corners move linearly from `before` to `now`. A search halves the time: no point of the
/// segment moves faster relative to a point of the face than the fastest of their corners do, so
/// the distance in the middle of an interval bounds the distances in the whole interval.
bool passes(const ShaftMotion& segment, const Triangle& before, const Triangle& now,
            double distance);

}  // namespace organ_collision::oracle
