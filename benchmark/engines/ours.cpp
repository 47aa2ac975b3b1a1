#include <limits>
#include <optional>

#include "engine.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "picking/gl/drawing.hpp"
#include "picking/pickers/picker.hpp"
#include "scan.hpp"

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

std::unique_ptr<Locator> make_our_near_locator() {
  CollisionRequest asked;
  asked.margin = kWhereLimit;
  asked.max_near = 100;
  return std::make_unique<OurLocator>(asked);
}

namespace {

/// One of the package's own pickers.
class PickerEngine : public Engine {
 public:
  explicit PickerEngine(const PickerSettings& settings) : picker_(make_picker(settings)) {}
  ~PickerEngine() override { picker_->release(); }

  void set_topology(const OrganSurface& organ, const std::vector<float>& rest) override {
    mesh_.emplace(rest, organ.triangles);
  }
  void update(const SharedVertices& vertices) override { mesh_->move_vertices(vertices); }

  void query(const VolumeQuery& query, std::vector<std::uint32_t>& faces) override {
    picker_->pick(query.volume, *mesh_, candidates_);
    faces.clear();
    for (const Candidate& candidate : candidates_) faces.push_back(candidate.face);
  }

 private:
  std::unique_ptr<Picker> picker_;
  std::optional<TriangleMesh> mesh_;
  std::vector<Candidate> candidates_;
};

}  // namespace

std::unique_ptr<Engine> make_ours() {
  return std::make_unique<PickerEngine>(PickerSettings(PickerKind::kFeedback, GlPlatform::kOsmesa));
}

std::unique_ptr<Engine> make_ours_egl() {
  return std::make_unique<PickerEngine>(PickerSettings(PickerKind::kFeedback, GlPlatform::kEgl));
}

std::unique_ptr<Engine> make_cpu() { return std::make_unique<PickerEngine>(PickerKind::kCpu); }

std::unique_ptr<Engine> make_select_paper() {
  return std::make_unique<PickerEngine>(PickerKind::kSelect);
}

}  // namespace organ_collision::bench
