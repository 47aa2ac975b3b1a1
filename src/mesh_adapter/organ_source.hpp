#pragma once

#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <ros/time.h>
#include <topic_tools/shape_shifter.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mesh_adapter_parameters.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "surface_messages.hpp"

namespace organ_collision {

/// Sends one organ's surface to the collision node. Sends only vertices if the triangles are
/// unchanged. Remembers the last legal mesh. Only the collision node limits the size of meshes.
class OrganFeed {
 public:
  struct Outlet {
    std::function<void(const OrganMeshPtr&)> mesh;
    std::function<void(const OrganVerticesPtr&)> vertices;
  };
  /// `last_topology`: the first mesh is sent with the next number. If a new feed replaces an old
  /// one while the collision node keeps running, its first mesh must not have the number of the old
  /// feed's last mesh: the collision node could refuse it, because it has other triangles under the
  /// same number.
  OrganFeed(std::string organ, std::uint32_t last_topology, Outlet outlet);

  /// Sends vertices if the triangles are those of the last mesh, otherwise a mesh with the next
  /// topology number. An empty surface removes the organ. Illegal surfaces are sent too, so that
  /// the collision node reports what is wrong with them, but they are not remembered: like the
  /// collision node, the feed keeps the last legal mesh. Moves the vertices out of `surface`.
  void send(ReceivedSurface& surface);

  /// Sends new vertices of the last mesh: x y z x y z ... [m]. Throws MessageError if there is no
  /// mesh, or if the mesh has another number of vertices.
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

/// One organ: reads its messages, of any supported type, and passes its surface to its feed. A
/// message that is refused changes nothing.
class OrganSource {
 public:
  OrganSource(OrganParameters parameters, std::uint32_t last_topology, OrganFeed::Outlet outlet);

  const OrganParameters& parameters() const { return parameters_; }

  /// Takes a message of `topic`. `arrival` replaces a missing stamp. Throws MessageError.
  void take_surface(const topic_tools::ShapeShifter& message, ros::Time arrival);
  /// Takes a message of `vertices_topic`, in the same way.
  void take_vertices(const topic_tools::ShapeShifter& message, ros::Time arrival);

  /// See OrganFeed::mesh().
  OrganMeshPtr mesh() const { return feed_.mesh(); }

 private:
  void read(const topic_tools::ShapeShifter& message);
  std::string frame_or_given(const std::string& named);

  OrganParameters parameters_;
  OrganFeed feed_;
  MarkerReader marker_reader_;
  ReceivedSurface surface_;  ///< of the last message; kept only to reuse its memory
  bool has_warned_ = false;
};

}  // namespace organ_collision
