// The messages that organ_mesh_adapter converts: bytes from the wire, to organ messages. Kinds of
// message: shape_msgs/Mesh, pcl_msgs/PolygonMesh, Marker, a cloud of vertices.
#include <pcl_msgs/PolygonMesh.h>
#include <sensor_msgs/PointCloud2.h>
#include <shape_msgs/Mesh.h>
#include <visualization_msgs/Marker.h>

#include "fuzz_input.hpp"
#include "mesh_adapter/organ_source.hpp"
#include "mesh_adapter/surface_messages.hpp"

using namespace organ_collision;

namespace {

/// The next bytes, as a subscriber receives them.
template <typename Message>
topic_tools::ShapeShifter received(FuzzInput& input) {
  namespace traits = ros::message_traits;
  topic_tools::ShapeShifter message;
  message.morph(traits::md5sum<Message>(), traits::datatype<Message>(),
                traits::definition<Message>(), "0");
  std::string bytes = input.sized_text();
  if (bytes.empty()) return message;  // ShapeShifter::read() would copy nothing to a null pointer.
  ros::serialization::IStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()),
                                     static_cast<std::uint32_t>(bytes.size()));
  message.read(stream);
  return message;
}

void take(FuzzInput& input, OrganSource& source) {
  const ros::Time arrival(50);
  switch (input.byte() % 4) {
    case 0:
      return source.take_surface(received<shape_msgs::Mesh>(input), arrival);
    case 1:
      return source.take_surface(received<pcl_msgs::PolygonMesh>(input), arrival);
    case 2:
      return source.take_surface(received<visualization_msgs::Marker>(input), arrival);
    default:
      source.take_vertices(received<sensor_msgs::PointCloud2>(input), arrival);
  }
}

}  // namespace

static const FuzzTarget target("mesh_adapter", [](const std::uint8_t* data, std::size_t size) {
  FuzzInput input(data, size);
  const OrganSource::Callbacks callbacks{
      [](const OrganMeshPtr& mesh) { demand(mesh->organ == "liver", "a mesh names its organ"); },
      [](const OrganVerticesPtr& mesh) { demand(!mesh->vertices.empty(), "there are vertices"); }};
  OrganSource source({"liver", "mesh", input.byte() % 2 == 0 ? "" : "liver_frame", "cloud"}, 7,
                     callbacks);
  while (!input.empty()) {
    try {
      take(input, source);
    } catch (const MessageError&) {
    }
  }
  const OrganMeshPtr mesh = source.mesh();
  demand(!mesh || !mesh->triangles.empty(), "the last legal mesh has faces");
});
