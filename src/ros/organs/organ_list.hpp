#pragma once

#include <organ_collision/OrganInfo.h>

#include <memory>
#include <vector>

#include "organ_registry.hpp"
#include "organ_surface.hpp"

namespace organ_collision {

/// An organ as it was when it was listed.
struct ListedOrgan {
  OrganInfo info;  ///< still without `closed` and `volume`, which take time for a large mesh
  std::shared_ptr<OrganSurface> surface;
  SharedVertices vertices;
};

/// All organs, sorted by name. For the thread that owns the organs: does not read their vertices.
std::vector<ListedOrgan> list_organs(const OrganRegistry& organs);

/// The organ with `closed` and `volume`. For the background thread: finds out what is not yet
/// known.
OrganInfo completed(const ListedOrgan& organ);

}  // namespace organ_collision
