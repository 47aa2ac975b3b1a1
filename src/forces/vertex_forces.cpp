#include "vertex_forces.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/concatenate.hpp"
#include "ros/interface/conversions.hpp"
#include "ros/interface/rejection.hpp"

namespace organ_collision {
namespace {

constexpr double kTolerance = 1e-6;  // [1]

void check_barycentric(const FaceForce& at) {
  const auto& b = at.barycentric;
  const bool is_in_face = std::min({b[0], b[1], b[2]}) >= -kTolerance;
  if (is_in_face && std::abs(b[0] + b[1] + b[2] - 1.0) <= kTolerance) return;
  throw Rejection(
      ContactArray::INVALID_REQUEST, "no barycentric coordinates",
      concatenate("the barycentric coordinates of face ", at.face, " are ", b[0], " ", b[1], " ",
                  b[2],
                  "; must not be negative, and their sum must be 1, else no vertex forces follow"));
}

}  // namespace

VertexForces vertex_forces(const ContactArray& contacts, const std::vector<FaceForce>& forces) {
  std::map<std::uint32_t, Eigen::Vector3d> at_vertices;
  for (const FaceForce& at : forces) {
    if (at.force.isZero(0.0)) continue;
    check_barycentric(at);
    for (std::size_t k = 0; k < 3; ++k) {
      if (at.barycentric[k] == 0.0) continue;
      at_vertices.insert({at.vertices[k], Eigen::Vector3d::Zero()}).first->second -=
          at.barycentric[k] * at.force;
    }
  }
  VertexForces message;
  message.header = contacts.header;
  message.organ = contacts.organ;
  message.topology = contacts.topology;
  message.tool = contacts.tool;
  message.vertices.reserve(at_vertices.size());
  message.forces.reserve(at_vertices.size());
  for (const auto& [vertex, force] : at_vertices) {
    message.vertices.push_back(vertex);
    message.forces.push_back(to_vector(force));
  }
  return message;
}

}  // namespace organ_collision
