#include "engine.hpp"
#include "exact_clip.hpp"
#include "scan_outcodes.hpp"

namespace organ_collision::bench {
namespace {

class Scan : public Engine {
 public:
  void set_topology(const OrganSurface& organ, const std::vector<float>&) override {
    organ_ = &organ;
  }
  void update(const SharedVertices& vertices) override { vertices_ = vertices.get(); }

  void query(const VolumeQuery& query, std::vector<std::uint32_t>& faces) override {
    find_outcodes(*vertices_, query.half_spaces, outcodes_);
    find_survivors(organ_->triangles, outcodes_, survivors_);
    faces.clear();
    for (const std::uint32_t face : survivors_) {
      if (meets(corners(*organ_, *vertices_, face), query.half_spaces)) faces.push_back(face);
    }
  }

 private:
  const OrganSurface* organ_ = nullptr;
  const std::vector<float>* vertices_ = nullptr;
  std::vector<std::uint8_t> outcodes_;
  std::vector<std::uint32_t> survivors_;
};

}  // namespace

std::unique_ptr<Engine> make_scan() { return std::make_unique<Scan>(); }

}  // namespace organ_collision::bench
