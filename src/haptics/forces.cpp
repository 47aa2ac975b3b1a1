#include "forces.hpp"

#include <algorithm>

#include "common/messages/conversions.hpp"
#include "common/messages/failure_log.hpp"

namespace organ_collision {

namespace {

using Eigen::Vector3d;

// Not std::isalpha() and std::isalnum(): they depend on the locale.
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_legal(char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; }

std::string graph_name(std::string name, const std::string& prefix) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !is_legal(c); }, '_');
  return !name.empty() && is_letter(name.front()) ? name : prefix + name;
}

}  // namespace

double share_within_limit(const Vector3d& load, double most) {
  const double magnitude = load.stableNorm();
  return magnitude <= most ? 1.0 : most / magnitude;
}

VertexForces vertex_forces(const ContactArray& contacts, const std::vector<FaceForce>& forces) {
  std::map<std::uint32_t, Vector3d> at_vertices;
  for (const FaceForce& at : forces) {
    if (at.force.isZero(0.0)) continue;
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
