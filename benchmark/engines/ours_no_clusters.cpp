#include "engine.hpp"
#include "picking/gl/feedback.hpp"
#include "scan_outcodes.hpp"

namespace organ_collision::bench {
namespace {

/// The feedback picker without its clusters. The outcodes of all vertices decide which faces GL has
/// to clip.
class OursNoClusters : public Engine {
 public:
  void set_topology(const OrganSurface& organ, const std::vector<float>&) override {
    organ_ = &organ;
  }
  void update(const SharedVertices& vertices) override { vertices_ = vertices.get(); }

  void query(const VolumeQuery& query, std::vector<std::uint32_t>& faces) override {
    find_outcodes(*vertices_, query.half_spaces, outcodes_);
    find_survivors(organ_->triangles, outcodes_, survivors_);
    drawn_.clear();
    for (const std::uint32_t face : survivors_) draw(face, query.volume.origin());
    faces.clear();
    if (drawn_.empty()) return;
    const std::size_t size = draw_feedback(context_, query.volume, drawn_, buffer_);
    for_each_vertex(buffer_, size, [&](const FeedbackVertex& vertex) {
      if (faces.empty() || faces.back() != vertex.face()) faces.push_back(vertex.face());
    });
  }

 private:
  void draw(std::uint32_t face, const Eigen::Vector3d& origin) {
    drawn_.add(shifted(corners(*organ_, *vertices_, face), origin), face);
  }

  GlContext context_;
  const OrganSurface* organ_ = nullptr;
  const std::vector<float>* vertices_ = nullptr;
  std::vector<std::uint8_t> outcodes_;
  std::vector<std::uint32_t> survivors_;
  DrawnFaces drawn_;
  std::vector<float> buffer_ = std::vector<float>(4096);
};

}  // namespace

std::unique_ptr<Engine> make_ours_no_clusters() { return std::make_unique<OursNoClusters>(); }

}  // namespace organ_collision::bench
