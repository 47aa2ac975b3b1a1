#include "forces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/messages/conversions.hpp"
#include "common/messages/failure_log.hpp"
#include "geometry/concatenate.hpp"

namespace organ_collision {

namespace {

using Eigen::Vector3d;

constexpr double kTolerance = 1e-6;  // [1]

void check_barycentric(const FaceForce& at) {
  const auto& b = at.barycentric;
  if (b.minCoeff() >= -kTolerance && std::abs(b.sum() - 1.0) <= kTolerance) return;
  throw Rejection(
      ContactArray::INVALID_REQUEST, "no barycentric coordinates",
      concatenate("the barycentric coordinates of face ", at.face, " are ", b[0], " ", b[1], " ",
                  b[2],
                  "; must not be negative, and their sum must be 1, else no vertex forces follow"));
}

// Not std::isalpha() and std::isalnum(): they depend on the locale.
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_legal(char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; }

std::string graph_name(std::string name, const std::string& prefix) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !is_legal(c); }, '_');
  return !name.empty() && is_letter(name.front()) ? name : prefix + name;
}

}  // namespace

Vector3d sum_of(const std::vector<FaceForce>& forces) {
  Vector3d sum = Vector3d::Zero();
  for (const FaceForce& at : forces) sum += at.force;
  return sum;
}

geometry_msgs::Wrench wrench_of(const std::vector<FaceForce>& forces) {
  Vector3d torque = Vector3d::Zero();
  for (const FaceForce& at : forces) torque += at.place.cross(at.force);
  geometry_msgs::Wrench wrench;
  wrench.force = to_vector(sum_of(forces));
  wrench.torque = to_vector(torque);
  return wrench;
}

double share_within_limit(const Vector3d& load, double most) {
  const double magnitude = load.stableNorm();
  return magnitude <= most ? 1.0 : most / magnitude;
}

bool limit_force(std::vector<FaceForce>& forces, double max_force) {
  const double share = share_within_limit(sum_of(forces), max_force);
  if (share == 1.0) return false;
  for (FaceForce& at : forces) at.force *= share;
  return true;
}

VertexForces vertex_forces(const ContactArray& contacts, const std::vector<FaceForce>& forces) {
  std::map<std::uint32_t, Vector3d> at_vertices;
  for (const FaceForce& at : forces) {
    if (at.force.isZero(0.0)) continue;
    check_barycentric(at);
    for (std::size_t k = 0; k < 3; ++k) {
      if (at.barycentric[k] == 0.0) continue;
      at_vertices.insert({at.vertices[k], Vector3d::Zero()}).first->second -=
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

std::string tool_graph_name(const std::string& tool) { return graph_name(tool, "tool_"); }

std::string PairNames::of(const std::string& organ, const std::string& tool) {
  std::string name = graph_name(organ, "organ_") + "/" + tool_graph_name(tool);
  const auto& owner = owners_.insert({name, {organ, tool}}).first->second;
  if (owner != std::make_pair(organ, tool)) {
    throw Rejection(ContactArray::INVALID_REQUEST, "name taken",
                    "the topics " + name + " belong to organ '" + owner.first + "', tool '" +
                        owner.second + "'; the names must differ in letters or digits");
  }
  return name;
}

}  // namespace organ_collision
