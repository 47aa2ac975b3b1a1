#pragma once

#include <organ_collision/Contact.h>

#include <cstddef>
#include <vector>

namespace organ_collision {

/// For each contact, the index of the contact of the same link that is nearest the tool in its
/// surroundings: the way there leads from each face to one that holds its point and comes nearer. A
/// contact that is nearest itself has its own index. Those are the local minima of the distance
/// between the tool and the surface, the same ones however finely the surface is divided; the
/// normals of all others say where on their faces the nearest point is, not how the surface lies.
/// Of n contacts it takes O(n log n) time.
std::vector<std::size_t> basins_of(const std::vector<Contact>& contacts);

}  // namespace organ_collision
