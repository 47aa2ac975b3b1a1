#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include "locator.hpp"

namespace organ_collision::bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

class CgalSide : public Locator {
 public:
  void set_topology(const OrganSurface& organ) override {
    mesh_.clear();
    for (std::size_t i = 0; i < organ.vertices.size(); i += 3) {
      mesh_.add_vertex(
          Kernel::Point_3(organ.vertices[i], organ.vertices[i + 1], organ.vertices[i + 2]));
    }
    for (std::size_t i = 0; i < organ.triangles.size(); i += 3) {
      mesh_.add_face(Mesh::Vertex_index(organ.triangles[i]),
                     Mesh::Vertex_index(organ.triangles[i + 1]),
                     Mesh::Vertex_index(organ.triangles[i + 2]));
    }
  }

  void update(const SharedVertices& vertices) override {
    for (const Mesh::Vertex_index vertex : mesh_.vertices()) {
      const float* xyz = &(*vertices)[3 * static_cast<std::size_t>(vertex)];
      mesh_.point(vertex) = Kernel::Point_3(xyz[0], xyz[1], xyz[2]);
    }
    side_.emplace(mesh_);
  }

  /// The first call after an update builds the tree.
  Location locate(const ShaftAxis& axis, double /*radius*/) override {
    const Eigen::Vector3d& tip = axis.tip;
    Location location;
    location.tip_inside = (*side_)({tip.x(), tip.y(), tip.z()}) == CGAL::ON_BOUNDED_SIDE;
    return location;
  }

 private:
  Mesh mesh_;
  std::optional<CGAL::Side_of_triangle_mesh<Mesh, Kernel>> side_;
};

}  // namespace

std::unique_ptr<Locator> make_cgal_locator() { return std::make_unique<CgalSide>(); }

}  // namespace organ_collision::bench
