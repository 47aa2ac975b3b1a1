#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/utility.h>
#include <fcl/narrowphase/detail/gjk_solver_libccd.h>
#include <fcl/narrowphase/detail/traversal/collision/mesh_shape_collision_traversal_node.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>
#include <fcl/narrowphase/detail/traversal/distance/mesh_shape_distance_traversal_node.h>

#include <algorithm>

#include "engine.hpp"
#include "exact_clip.hpp"

namespace organ_collision::bench {
namespace {

using Model = fcl::BVHModel<fcl::AABB<double>>;
using Solver = fcl::detail::GJKSolver_libccd<double>;
using Node =
    fcl::detail::MeshShapeCollisionTraversalNode<fcl::AABB<double>, fcl::Convex<double>, Solver>;

std::vector<fcl::Vector3<double>> points(const std::vector<float>& vertices) {
  std::vector<fcl::Vector3<double>> points;
  points.reserve(vertices.size() / 3);
  for (std::size_t i = 0; i < vertices.size(); i += 3) {
    points.emplace_back(vertices[i], vertices[i + 1], vertices[i + 2]);
  }
  return points;
}

fcl::Convex<double> convex(const ConvexSolid& solid) {
  auto sides = std::make_shared<std::vector<int>>();
  for (const std::vector<int>& side : solid.sides) {
    sides->push_back(static_cast<int>(side.size()));
    sides->insert(sides->end(), side.begin(), side.end());
  }
  return {std::make_shared<std::vector<fcl::Vector3<double>>>(solid.corners),
          static_cast<int>(solid.sides.size()), sides};
}

/// Calls the parts of fcl::collide instead of fcl::collide itself, which first copies the whole
/// model if its boxes are axis-aligned.
class Fcl : public Engine {
 public:
  void set_topology(const OrganSurface& organ, const std::vector<float>& rest) override {
    std::vector<fcl::Triangle> triangles;
    for (std::size_t i = 0; i < organ.triangles.size(); i += 3) {
      triangles.emplace_back(organ.triangles[i], organ.triangles[i + 1], organ.triangles[i + 2]);
    }
    model_.beginModel(static_cast<int>(triangles.size()), static_cast<int>(rest.size() / 3));
    model_.addSubModel(points(rest), triangles);
    model_.endModel();
  }

  void update(const SharedVertices& vertices) override {
    model_.beginReplaceModel();
    model_.replaceSubModel(points(*vertices));
    model_.endReplaceModel(true, true);
  }

  void query(const VolumeQuery& query, std::vector<std::uint32_t>& faces) override {
    const fcl::Convex<double> tool = convex(query.solid);
    const fcl::CollisionRequest<double> request(static_cast<std::size_t>(model_.num_tris), false);
    fcl::CollisionResult<double> result;
    fcl::Transform3<double> rest = fcl::Transform3<double>::Identity();
    Node node;
    fcl::detail::initialize(node, model_, rest, tool, rest, &solver_, request, result);
    const Eigen::AlignedBox3d box = box_within_organ(query);
    node.model2_bv = fcl::AABB<double>(box.min(), box.max());
    fcl::detail::collide(&node);
    faces.clear();
    for (std::size_t i = 0; i < result.numContacts(); ++i) {
      faces.push_back(static_cast<std::uint32_t>(result.getContact(i).b1));
    }
    std::sort(faces.begin(), faces.end());
  }

 private:
  Model model_;
  Solver solver_;
};

}  // namespace

std::unique_ptr<Engine> make_fcl() { return std::make_unique<Fcl>(); }

namespace {

using Boxes = fcl::AABB<double>;
using Shaft = fcl::Capsule<double>;

/// Calls the parts of fcl::distance, which itself refuses trees of axis-aligned boxes. The other
/// trees take ten times as long to refit, and the distances of refitted trees of RSS and OBBRSS are
/// wrong by up to 0.16 m.
class FclDistance : public Locator {
 public:
  void set_topology(const OrganSurface& organ) override {
    std::vector<fcl::Triangle> triangles;
    for (std::size_t i = 0; i < organ.triangles.size(); i += 3) {
      triangles.emplace_back(organ.triangles[i], organ.triangles[i + 1], organ.triangles[i + 2]);
    }
    model_.beginModel(static_cast<int>(triangles.size()),
                      static_cast<int>(organ.vertices.size() / 3));
    model_.addSubModel(points(organ.vertices), triangles);
    model_.endModel();
  }

  void update(const SharedVertices& vertices) override {
    model_.beginReplaceModel();
    model_.replaceSubModel(points(*vertices));
    model_.endReplaceModel(true, true);
  }

  Location locate(const ShaftAxis& axis, double radius) override {
    const Eigen::Vector3d along = axis.tip - axis.trocar;
    const Shaft shaft(radius, along.norm());
    fcl::DistanceResult<double> result;
    fcl::detail::MeshShapeDistanceTraversalNode<Boxes, Shaft, Solver> node;
    node.result = &result;
    node.model1 = &model_;
    node.vertices = model_.vertices;
    node.tri_indices = model_.tri_indices;
    node.tf1.setIdentity();
    node.model2 = &shaft;
    node.tf2.linear() =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), along).toRotationMatrix();
    node.tf2.translation() = axis.at(0.5);
    fcl::computeBV(shaft, node.tf2, node.model2_bv);
    node.nsolver = &solver_;
    fcl::detail::distance(&node);
    Location location;
    location.shaft_distance = result.min_distance;
    return location;
  }

 private:
  fcl::BVHModel<Boxes> model_;
  Solver solver_;
};

}  // namespace

std::unique_ptr<Locator> make_fcl_locator() { return std::make_unique<FclDistance>(); }

}  // namespace organ_collision::bench
