#include <limits>
#include <optional>

#include "locator.hpp"
#include "organ_collision/query/collision_query.hpp"

namespace organ_collision::bench {
namespace {

class OurLocator : public Locator {
 public:
  /// `asked`: what else than contacts a request asks for.
  explicit OurLocator(const CollisionRequest& asked) : asked_(asked) {}

  void set_topology(const OrganSurface& organ) override {
    mesh_.emplace(organ.vertices, organ.triangles);
    topology_.emplace(mesh_->faces(), mesh_->vertices());
  }

  void update(const SharedVertices& vertices) override { mesh_->move_vertices(vertices); }

  Location locate(const ShaftAxis& axis, double radius) override {
    CollisionRequest request = asked_;
    request.organ = &*mesh_;
    request.surface_topology = &*topology_;
    request.path = resting_path({axis, {}});
    request.radius = radius;
    query_.evaluate(request, result_);
    Location location;
    if (result_.clearance.state == ClearanceState::kKnown) {
      location.shaft_distance = result_.clearance.distance;
    } else {
      location.shaft_distance = std::numeric_limits<double>::infinity();
    }
    if (request.placement) location.tip_inside = result_.placement.tip == Side::kInside;
    return location;
  }

 private:
  CollisionRequest asked_;
  std::optional<TriangleMesh> mesh_;
  std::optional<SurfaceTopology> topology_;
  CollisionQuery query_;
  CollisionResult result_;
};

}  // namespace

std::unique_ptr<Locator> make_our_locator() {
  CollisionRequest asked;
  asked.margin = kWhereLimit;
  asked.placement = true;
  return std::make_unique<OurLocator>(asked);
}

std::unique_ptr<Locator> make_our_unlimited_locator() {
  CollisionRequest asked;
  asked.clearance = true;
  asked.placement = true;
  return std::make_unique<OurLocator>(asked);
}

std::unique_ptr<Locator> make_our_near_locator() {
  CollisionRequest asked;
  asked.margin = kWhereLimit;
  asked.max_near = 100;
  return std::make_unique<OurLocator>(asked);
}

}  // namespace organ_collision::bench
