#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

#include <iterator>

#include "engine.hpp"
#include "exact_clip.hpp"

namespace organ_collision::bench {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;

/// A face, identified by its number. Its corners are read from the organ's present shape.
class Face {
 public:
  using Id = std::uint32_t;
  using Point = Kernel::Point_3;
  using Datum = Kernel::Triangle_3;
  using Point_reference = Point;
  using Datum_reference = Datum;

  Face(const OrganSurface& organ, const std::vector<float>& vertices, Id id)
      : organ_(&organ), vertices_(&vertices), id_(id) {}
  explicit Face(std::vector<Face>::const_iterator face) : Face(*face) {}

  Id id() const { return id_; }
  Point reference_point() const { return corner(0); }
  Datum datum() const { return {corner(0), corner(1), corner(2)}; }

 private:
  Point corner(std::size_t i) const {
    const float* xyz = &(*vertices_)[3 * organ_->triangles[3 * id_ + i]];
    return {xyz[0], xyz[1], xyz[2]};
  }

  const OrganSurface* organ_;
  const std::vector<float>* vertices_;
  Id id_;
};

class Cgal : public Engine {
 public:
  void set_topology(const OrganSurface& organ, const std::vector<float>&) override {
    organ_ = &organ;
  }

  void update(const SharedVertices& vertices) override {
    vertices_ = vertices.get();
    faces_.clear();
    for (std::uint32_t i = 0; i < organ_->face_count(); ++i) {
      faces_.emplace_back(*organ_, *vertices, i);
    }
    tree_.rebuild(faces_.cbegin(), faces_.cend());
    tree_.build();
  }

  void query(const VolumeQuery& query, std::vector<std::uint32_t>& faces) override {
    const Eigen::AlignedBox3d tool = box_within_organ(query);
    const Eigen::Vector3d &low = tool.min(), &high = tool.max();
    const Kernel::Iso_cuboid_3 box({low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()});
    faces.clear();
    tree_.all_intersected_primitives(box, std::back_inserter(faces));
    keep_faces_that_meet(query, *organ_, *vertices_, faces);
  }

 private:
  const OrganSurface* organ_ = nullptr;
  const std::vector<float>* vertices_ = nullptr;
  std::vector<Face> faces_;
  CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Face>> tree_;
};

}  // namespace

std::unique_ptr<Engine> make_cgal() { return std::make_unique<Cgal>(); }

namespace {

using SideKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<SideKernel::Point_3>;

class CgalSide : public Locator {
 public:
  void set_topology(const OrganSurface& organ) override {
    mesh_.clear();
    for (std::size_t i = 0; i < organ.vertices.size(); i += 3) {
      mesh_.add_vertex(
          SideKernel::Point_3(organ.vertices[i], organ.vertices[i + 1], organ.vertices[i + 2]));
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
      mesh_.point(vertex) = SideKernel::Point_3(xyz[0], xyz[1], xyz[2]);
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
  std::optional<CGAL::Side_of_triangle_mesh<Mesh, SideKernel>> side_;
};

}  // namespace

std::unique_ptr<Locator> make_cgal_locator() { return std::make_unique<CgalSide>(); }

}  // namespace organ_collision::bench
