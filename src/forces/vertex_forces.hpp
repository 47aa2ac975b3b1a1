#pragma once

#include <organ_collision/ContactArray.h>
#include <organ_collision/VertexForces.h>

#include <vector>

#include "face_force.hpp"

namespace organ_collision {

/// The forces of the tool on the tissue's vertices. Minus each face's force is divided among the
/// face's vertices by the barycentric coordinates of its point. Therefore the sum of the
/// vertices' forces is minus that of the faces' forces, and the same holds for their torques, up to
/// rounding. Vertices without a force are left out. `contacts`: the answer that the forces are
/// from.
///
/// Throws Rejection if the barycentric coordinates of a point with a force are not finite, or if
/// their sum is not 1 (to 1e-6).
VertexForces vertex_forces(const ContactArray& contacts, const std::vector<FaceForce>& forces);

}  // namespace organ_collision
