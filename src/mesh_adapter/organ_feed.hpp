#pragma once

#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "received_surface.hpp"

namespace organ_collision {

/// Sends one organ's surface to the collision node. Sends only vertices if these suffice. Remembers
/// the last mesh that the collision node accepts.
class OrganFeed {
 public:
  struct Outlet {
    std::function<void(const OrganMeshPtr&)> mesh;
    std::function<void(const OrganVerticesPtr&)> vertices;
  };
  /// `last_topology`: the first mesh is sent with the next number. If a new feed replaces one whose
  /// collision node is still running, it must not begin with the number of the old feed's last
  /// mesh: the collision node would take other triangles for the same ones.
  OrganFeed(std::string organ, std::uint32_t last_topology, Outlet outlet);

  /// Sends vertices if the triangles are those of the last mesh, otherwise a mesh with the next
  /// topology. An empty surface removes the organ. Illegal surfaces are sent too, so that the
  /// collision node reports what is wrong with them, but they are not remembered: the collision
  /// node keeps the last legal mesh, and so does this. Moves the vertices out of `surface`.
  void send(ReceivedSurface& surface);

  /// Sends new vertices of the last mesh: x y z x y z ... [m]. Throws MessageError if there is no
  /// mesh, or if it has another number of vertices.
  void send_vertices(const std::string& frame, ros::Time stamp, std::vector<float> vertices);

  /// The last legal mesh with the last legal vertices; null if there is none.
  OrganMeshPtr mesh() const;

 private:
  void send_mesh(ReceivedSurface& surface, std::uint32_t topology);
  bool has_triangles(const ReceivedSurface& surface) const;
  void move(SharedVertices vertices, ros::Time stamp);

  std::string organ_;
  std::uint32_t last_topology_;
  Outlet outlet_;

  std::optional<TriangleMesh> mesh_;  ///< shares the vertices of the message that was sent
  std::string frame_;
  ros::Time stamp_;
};

}  // namespace organ_collision
