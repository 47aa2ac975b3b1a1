#include "mesh_conversions.hpp"

#include <string>

#include "message_error.hpp"
#include "point_cloud_reader.hpp"

namespace organ_collision {

void convert(const shape_msgs::Mesh& mesh, ReceivedSurface& surface) {
  surface.frame.clear();
  surface.stamp = {};
  surface.vertices.resize(3 * mesh.vertices.size());
  float* coordinate = surface.vertices.data();
  for (const geometry_msgs::Point& vertex : mesh.vertices) {
    for (const double value : {vertex.x, vertex.y, vertex.z}) {
      *coordinate++ = static_cast<float>(value);
    }
  }
  surface.triangles.clear();
  surface.triangles.reserve(3 * mesh.triangles.size());
  for (const shape_msgs::MeshTriangle& triangle : mesh.triangles) {
    surface.triangles.insert(surface.triangles.end(), triangle.vertex_indices.begin(),
                             triangle.vertex_indices.end());
  }
}

void convert(const pcl_msgs::PolygonMesh& mesh, ReceivedSurface& surface) {
  const std_msgs::Header &own = mesh.header, &clouds = mesh.cloud.header;
  surface.frame = own.frame_id.empty() ? clouds.frame_id : own.frame_id;
  surface.stamp = own.stamp.isZero() ? clouds.stamp : own.stamp;
  read_points(mesh.cloud, surface.vertices);
  surface.triangles.clear();
  for (std::size_t i = 0; i < mesh.polygons.size(); ++i) {
    const auto& corners = mesh.polygons[i].vertices;
    if (corners.size() < 3) {
      throw MessageError("polygon without area", "polygon " + std::to_string(i) + " has " +
                                                     std::to_string(corners.size()) +
                                                     " corners; must have at least 3");
    }
    for (std::size_t last = 2; last < corners.size(); ++last) {
      surface.triangles.insert(surface.triangles.end(),
                               {corners[0], corners[last - 1], corners[last]});
    }
  }
}

}  // namespace organ_collision
