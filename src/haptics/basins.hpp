#pragma once

#include <organ_collision/Contact.h>

#include <cstddef>
#include <vector>

namespace organ_collision {

/// Finds the local minima of the distance between the tool and the surface, and the basin of each.
///
/// Returns for each contact the index of the contact at the bottom of its basin. Both are of the
/// same link. A path leads to the bottom. Each step of the path goes from a face to another face
/// that contains its contact point and extends nearer to the tool. A contact that is itself a local
/// minimum has its own index.
///
/// The local minima do not depend on how finely the surface is divided. The normals of the other
/// contacts show where on its face the nearest point is, not how the surface is oriented.
/// Takes O(n log n) time for n contacts.
std::vector<std::size_t> basins_of(const std::vector<Contact>& contacts);

}  // namespace organ_collision
