#pragma once

#include <organ_collision/ProxyContact.h>

#include <cstddef>
#include <vector>

#include "organ_collision/query/haptic_proxy.hpp"
#include "tool_proxy.hpp"

namespace organ_collision {

/// Finds the local minima of the distance between the tool and the tissue, and the basin of each.
///
/// Returns for each contact the index of the contact at the bottom of its basin. Both are of the
/// same organ and link. A path leads to the bottom. Each step of the path goes from a face to the
/// nearest one of those that contain its nearest point, if that one is nearer to the tool. A
/// contact that is itself a local minimum has its own index.
///
/// The local minima do not depend on how finely the surface is divided. The normals of the other
/// contacts show where on its face the nearest point is, not how the surface is oriented.
/// Takes O(n log n) time for n contacts.
std::vector<std::size_t> basins_of(const std::vector<ProxyFace>& contacts);

/// What ProxyState.contacts has: the nearest places of all locally convex patches of tissue near
/// the proxy, each with the force on the whole patch. `report`: with an answer.
std::vector<ProxyContact> places_of(const ProxyReport& report);

}  // namespace organ_collision
