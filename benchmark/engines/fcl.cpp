#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/utility.h>
#include <fcl/narrowphase/detail/gjk_solver_libccd.h>
#include <fcl/narrowphase/detail/traversal/collision/mesh_shape_collision_traversal_node.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>
#include <fcl/narrowphase/detail/traversal/distance/mesh_shape_distance_traversal_node.h>

#include <algorithm>
#include <optional>

#include "engine.hpp"
#include "exact_clip.hpp"

namespace organ_collision::bench {
namespace {

using Boxes = fcl::AABB<double>;
using OrientedBoxes = fcl::OBBRSS<double>;
using Solver = fcl::detail::GJKSolver_libccd<double>;

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

/// The traversal of a tree of `Box` with a volume.
template <typename Box>
struct Traversal {
  using Model = fcl::BVHModel<Box>;
  using Node = fcl::detail::MeshShapeCollisionTraversalNode<Box, fcl::Convex<double>, Solver>;
  static void limit(Node& node, const VolumeQuery& query) {
    const Eigen::AlignedBox3d box = box_within_organ(query);
    node.model2_bv = Box(box.min(), box.max());
  }
};

template <>
struct Traversal<OrientedBoxes> {
  // Without const, a call of FCL's initialize() would be ambiguous.
  using Model = const fcl::BVHModel<OrientedBoxes>;
  using Node = fcl::detail::MeshShapeCollisionTraversalNodeOBBRSS<fcl::Convex<double>, Solver>;
  static void limit(Node&, const VolumeQuery&) {}  // FCL's oriented box around the volume is tight.
};

/// Calls the parts of fcl::collide instead of fcl::collide itself, which first copies the whole
/// model if its boxes are axis-aligned.
template <typename Box>
class Fcl : public Engine {
 public:
  /// `rebuilds`: makes a new tree for each shape, instead of refitting the first one.
  explicit Fcl(bool rebuilds) : rebuilds_(rebuilds) {}

  void set_topology(const OrganSurface& organ, const std::vector<float>& rest) override {
    for (std::size_t i = 0; i < organ.triangles.size(); i += 3) {
      triangles_.emplace_back(organ.triangles[i], organ.triangles[i + 1], organ.triangles[i + 2]);
    }
    build(rest);
  }

  void update(const SharedVertices& vertices) override {
    if (rebuilds_) return build(*vertices);
    model_->beginReplaceModel();
    model_->replaceSubModel(points(*vertices));
    model_->endReplaceModel(true, true);
  }

  void query(const VolumeQuery& query, std::vector<std::uint32_t>& faces) override {
    const fcl::Convex<double> tool = convex(query.solid);
    const fcl::CollisionRequest<double> request(static_cast<std::size_t>(model_->num_tris), false);
    fcl::CollisionResult<double> result;
    fcl::Transform3<double> rest = fcl::Transform3<double>::Identity();
    typename Traversal<Box>::Model& model = *model_;
    typename Traversal<Box>::Node node;
    fcl::detail::initialize(node, model, rest, tool, rest, &solver_, request, result);
    Traversal<Box>::limit(node, query);
    fcl::detail::collide(&node);
    faces.clear();
    for (std::size_t i = 0; i < result.numContacts(); ++i) {
      faces.push_back(static_cast<std::uint32_t>(result.getContact(i).b1));
    }
    std::sort(faces.begin(), faces.end());
  }

 private:
  void build(const std::vector<float>& vertices) {
    model_.emplace();
    model_->beginModel(static_cast<int>(triangles_.size()), static_cast<int>(vertices.size() / 3));
    model_->addSubModel(points(vertices), triangles_);
    model_->endModel();
  }

  const bool rebuilds_;
  std::vector<fcl::Triangle> triangles_;
  std::optional<fcl::BVHModel<Box>> model_;
  Solver solver_;
};

}  // namespace

std::unique_ptr<Engine> make_fcl() { return std::make_unique<Fcl<Boxes>>(false); }
std::unique_ptr<Engine> make_fcl_obb() { return std::make_unique<Fcl<OrientedBoxes>>(false); }
std::unique_ptr<Engine> make_fcl_obb_rebuilt() {
  return std::make_unique<Fcl<OrientedBoxes>>(true);
}

namespace {

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
