#include <optional>

#include "engine.hpp"
#include "picking/pickers/picker.hpp"

namespace organ_collision::bench {
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
