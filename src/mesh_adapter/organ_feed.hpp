#pragma once

#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "surface.hpp"

namespace organ_collision {

/// Tells the collision node of one organ's surface, in as few words as will do, and remembers what
/// it was told last.
class OrganFeed {
 public:
  struct Outlet {
    std::function<void(const OrganMeshPtr&)> mesh;
    std::function<void(const OrganVerticesPtr&)> vertices;
  };
  /// `last_topology`: the one before the first. Where a feed begins anew for a collision node that
  /// goes on, another number than the old feed's last one, as that belongs to other triangles.
  OrganFeed(std::string organ, std::uint32_t last_topology, Outlet outlet);

  /// Sends vertices where the triangles are those that were sent last, else a mesh with the next
  /// topology; an empty one removes the organ. Illegal ones are sent too, so that the collision
  /// node can say what is wrong with them, but are not remembered: what comes next is compared to
  /// the last legal one, which the collision node still has. Takes the vertices from `surface`.
  void send(Surface& surface);

  /// Sends vertices of the last mesh (x y z x y z ... [m]). Throws MessageError if there is none,
  /// or if their number is another.
  void send_vertices(const std::string& frame, ros::Time stamp, std::vector<float> vertices);

  /// The last legal mesh with the last legal vertices; null if there is none.
  OrganMeshPtr mesh() const;

 private:
  void send_mesh(Surface& surface, std::uint32_t topology);
  bool has_triangles(const Surface& surface) const;
  void move(SharedVertices vertices, ros::Time stamp);

  std::string organ_;
  std::uint32_t last_topology_;
  Outlet outlet_;

  std::optional<TriangleMesh> mesh_;  ///< its vertices are those of the message, not a copy
  std::string frame_;
  ros::Time stamp_;
};

}  // namespace organ_collision
