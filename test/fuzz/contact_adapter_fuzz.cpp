// ContactArray as contact_adapter takes it: bytes from the wire, to forces and lists of faces. Each
// message has a byte before it: whether the radius of the shaft is known.
#include <cmath>

#include "contact_adapter/contact_answer.hpp"
#include "contact_adapter/force_law.hpp"
#include "forces/forces.hpp"
#include "fuzz_input.hpp"
#include "ros/messages/failure_log.hpp"

using namespace organ_collision;

namespace {

constexpr double kMaxForce = 5.0;  // [N]

void take(const ContactArray& answer, bool knows_radius, ForceLaw& law, PairNames& names) {
  check_contacts(answer);
  names.of(answer.organ, answer.tool);
  face_list(answer);
  if (!has_geometry(answer)) return;
  const ShaftRadius radius = knows_radius ? ShaftRadius(0.01) : std::nullopt;
  std::vector<FaceForce> forces = law.follow(answer, 0.001, 300.0, radius);
  limit_force(forces, kMaxForce);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const FaceForce& force : forces) sum += force.force;
  demand(sum.norm() <= kMaxForce * (1.0 + 1e-6), "the force is finite and limited");
  wrench_of(forces);
  for (const auto& force : vertex_forces(answer, forces).forces) {
    demand(std::isfinite(force.x + force.y + force.z), "forces on vertices are finite");
  }
}

}  // namespace

static const FuzzTarget target("contact_adapter", [](const std::uint8_t* data, std::size_t size) {
  FuzzInput input(data, size);
  ForceLaw law;
  PairNames names;
  while (!input.empty()) {
    const bool knows_radius = input.byte() % 2 == 1;
    const auto answer = next_message<ContactArray>(input);
    try {
      if (answer) take(*answer, knows_radius, law, names);
    } catch (const Rejection&) {
    }
  }
});
