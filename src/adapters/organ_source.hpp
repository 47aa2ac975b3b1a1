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

/// One organ: reads its messages, of any supported type, and sends its surface to the collision
/// node. Does not limit the size of meshes: the collision node does. A message that is refused
/// changes nothing.
class OrganSource {
 public:
  /// The functions that send messages to the collision node.
  struct Callbacks {
    std::function<void(const OrganMeshPtr&)> mesh;
    std::function<void(const OrganVerticesPtr&)> vertices;
  };
  /// The first mesh is sent with the topology number after `last_topology`. If a new source
  /// replaces an old one while the collision node keeps running, the number must differ from that
  /// of the old source's last mesh. The collision node could otherwise refuse the new mesh, because
  /// it knows other triangles under this number.
  OrganSource(OrganParameters parameters, std::uint32_t last_topology, Callbacks callbacks);

  const OrganParameters& parameters() const { return parameters_; }

  /// Takes a message of OrganParameters::topic. `arrival` replaces a missing stamp. Throws
  /// MessageError.
  ///
  /// Sends only vertices if the triangles and the frame are those of the last mesh. If only the
  /// frame is new, sends a mesh with the same topology number, otherwise one with the next number.
  /// An empty surface removes the organ. Illegal surfaces are sent too, so that the collision node
  /// reports what is wrong with them, but they are not remembered: like the collision node, the
  /// source keeps the last legal mesh.
  void take_surface(const topic_tools::ShapeShifter& message, ros::Time arrival);
  /// Takes a message of OrganParameters::vertices_topic, and sends its vertices. Throws
  /// MessageError also if there is no mesh, or if the mesh has another number of vertices.
  void take_vertices(const topic_tools::ShapeShifter& message, ros::Time arrival);

  /// To be called before the first message of a sender that has restarted. Its first shape replaces
  /// the organ: it is sent as a mesh with the next number, after a removal, so that the collision
  /// node forgets the organ's history.
  void restart() { has_restarted_ = mesh_.has_value(); }

  /// The last legal mesh with the last legal vertices; null if there is none.
  OrganMeshPtr mesh() const;

 private:
  ReceivedSurface read(const topic_tools::ShapeShifter& message);
  std::string frame_or_given(const std::string& named);
  void scale(std::vector<float>& vertices) const;
  void send_mesh(std::uint32_t topology, ReceivedSurface&& surface);
  void send_vertices(const std::string& frame, ros::Time stamp, std::vector<float> vertices);

  OrganParameters parameters_;
  std::uint32_t last_topology_;
  Callbacks callbacks_;
  MarkerReader marker_reader_;
  bool has_warned_ = false;
  bool has_restarted_ = false;  ///< the sender, since the last shape was sent

  std::optional<TriangleMesh> mesh_;  ///< shares the vertices of the message that was sent
  std::string frame_;                 ///< the frame of mesh_
  ros::Time stamp_;                   ///< the stamp of mesh_
};

}  // namespace organ_collision
