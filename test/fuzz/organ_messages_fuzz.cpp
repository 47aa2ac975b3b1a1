// OrganMesh and OrganVertices: bytes from the wire, to shapes of organs. Kinds of message: mesh,
// vertices.
#include <boost/make_shared.hpp>

#include "fuzz_input.hpp"
#include "ros/organs/organ_registry.hpp"

using namespace organ_collision;

namespace {

using Shapes = std::map<std::string, std::shared_ptr<const TriangleMesh>>;

Shapes shapes(const OrganRegistry& organs) {
  Shapes shapes;
  for (const auto& [name, organ] : organs.organs()) shapes[name] = organ.latest().mesh;
  return shapes;
}

void check_shapes(const OrganRegistry& organs) {
  for (const auto& [name, organ] : organs.organs()) {
    const TriangleMesh& mesh = *organ.latest().mesh;
    demand(mesh.face_count() > 0, "an organ has faces");
    for (std::size_t face = 0; face < mesh.face_count(); ++face) {
      for (const Eigen::Vector3d& corner : mesh.triangle(face)) {
        demand(corner.allFinite(), "the corners of faces are finite");
      }
    }
    summary(name, *organ.surface());
    doubts(name, mesh.box().cast<double>(), *organ.surface());
    organ.latest().age(ros::Time(50));
    demand(std::isfinite(info_of(organ).volume), "the volume is finite");
  }
}

template <typename Message>
void apply(FuzzInput& input, OrganRegistry& organs) {
  const auto message = next_message<Message>(input);
  if (!message) return;
  const Shapes before = shapes(organs);
  try {
    organs.apply(boost::make_shared<const Message>(*message), ros::Time(50));
  } catch (const Rejection&) {
    demand(shapes(organs) == before, "a refused message changes nothing");
  }
}

}  // namespace

static const FuzzTarget target("organ_messages", [](const std::uint8_t* data, std::size_t size) {
  FuzzInput input(data, size);
  OrganRegistry organs{MeshLimits{1000}};
  while (!input.empty()) {
    if (input.byte() % 2 == 0) {
      apply<OrganMesh>(input, organs);
    } else {
      apply<OrganVertices>(input, organs);
    }
  }
  check_shapes(organs);
});
