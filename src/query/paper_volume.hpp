#pragma once

#include "organ_collision/query/collision_query.hpp"
#include "picking/volumes/viewing_volume.hpp"

namespace organ_collision {

/// The viewing volume of a request in one of the paper's modes. `request` is otherwise legal (see
/// request_check.hpp). Throws VolumeError if its shaft is too short or too thin for the volume.
ViewingVolume paper_volume(const CollisionRequest& request);

}  // namespace organ_collision
