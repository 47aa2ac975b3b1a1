#include "organ_feed.hpp"

#include <boost/make_shared.hpp>
#include <limits>
#include <utility>

#include "message_error.hpp"

namespace organ_collision {
namespace {

/// The collision node decides how large an organ may be.
constexpr MeshLimits kNoLimits = {std::numeric_limits<std::uint32_t>::max() / 3};

template <typename Message>
boost::shared_ptr<Message> message_of(const std::string& organ, std::uint32_t topology,
                                      const std::string& frame, ros::Time stamp) {
  auto message = boost::make_shared<Message>();
  message->header.frame_id = frame;
  message->header.stamp = stamp;
  message->organ = organ;
  message->topology = topology;
  return message;
}

template <typename Message>
SharedVertices vertices_of(const boost::shared_ptr<Message>& message) {
  return {&message->vertices, [message](const void*) {}};
}

}  // namespace

OrganFeed::OrganFeed(std::string organ, std::uint32_t last_topology, Outlet outlet)
    : organ_(std::move(organ)), last_topology_(last_topology), outlet_(std::move(outlet)) {}

void OrganFeed::send(ReceivedSurface& surface) {
  if (surface.empty()) {
    mesh_.reset();
    outlet_.mesh(message_of<OrganMesh>(organ_, last_topology_, surface.frame, surface.stamp));
  } else if (!has_triangles(surface)) {
    send_mesh(surface, ++last_topology_);
  } else if (surface.frame != frame_) {
    send_mesh(surface, mesh_->topology());
  } else {
    send_vertices(surface.frame, surface.stamp, std::move(surface.vertices));
  }
}

/// Sends the message before it is checked here, so that the collision node need not wait.
void OrganFeed::send_mesh(ReceivedSurface& surface, std::uint32_t topology) {
  const auto message = message_of<OrganMesh>(organ_, topology, surface.frame, surface.stamp);
  message->vertices = std::move(surface.vertices);
  message->triangles = surface.triangles;
  outlet_.mesh(message);
  try {
    mesh_.emplace(TriangleMesh(vertices_of(message), message->triangles, topology, kNoLimits));
    frame_ = surface.frame;
    stamp_ = surface.stamp;
  } catch (const MeshError&) {  // The collision node refuses and reports the mesh.
  }
}

void OrganFeed::send_vertices(const std::string& frame, ros::Time stamp,
                              std::vector<float> vertices) {
  const std::string named =
      std::to_string(vertices.size() / 3) + " vertices for organ '" + organ_ + "'";
  if (!mesh_) throw MessageError("no mesh", named + ", which has no mesh; must come after one");
  if (vertices.size() != mesh_->vertices().size()) {
    throw MessageError("wrong number of vertices", named + "; must be as many as its mesh has, " +
                                                       std::to_string(mesh_->vertex_count()));
  }
  const auto message = message_of<OrganVertices>(organ_, mesh_->topology(), frame, stamp);
  message->vertices = std::move(vertices);
  outlet_.vertices(message);
  if (frame == frame_) move(vertices_of(message), stamp);
}

void OrganFeed::move(SharedVertices vertices, ros::Time stamp) {
  try {
    mesh_->move_vertices(std::move(vertices));
    stamp_ = stamp;
  } catch (const MeshError&) {  // The collision node refuses and reports the vertices.
  }
}

bool OrganFeed::has_triangles(const ReceivedSurface& surface) const {
  return mesh_ && surface.vertices.size() == mesh_->vertices().size() &&
         mesh_->has_triangles(surface.triangles);
}

OrganMeshPtr OrganFeed::mesh() const {
  if (!mesh_) return nullptr;
  auto message = message_of<OrganMesh>(organ_, mesh_->topology(), frame_, stamp_);
  message->vertices = mesh_->vertices();
  message->triangles.reserve(3 * mesh_->face_count());
  for (const FaceIndices& face : mesh_->faces()) {
    message->triangles.insert(message->triangles.end(), face.begin(), face.end());
  }
  return message;
}

}  // namespace organ_collision
