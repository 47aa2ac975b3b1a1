#include <BulletCollision/CollisionShapes/btOptimizedBvh.h>

#include <optional>

#include "bullet_mesh.hpp"
#include "engine.hpp"
#include "exact_clip.hpp"

namespace organ_collision::bench {
namespace {

class Collector : public btNodeOverlapCallback {
 public:
  explicit Collector(std::vector<std::uint32_t>& faces) : faces_(faces) {}
  void processNode(int /*part*/, int face) override {
    faces_.push_back(static_cast<std::uint32_t>(face));
  }

 private:
  std::vector<std::uint32_t>& faces_;
};

class BulletQuantized : public Engine {
 public:
  void set_topology(const OrganSurface& organ, const std::vector<float>& rest) override {
    organ_ = &organ;
    mesh_.emplace(organ, rest);
    mesh_->view().calculateAabbBruteForce(low_, high_);
    // Bullet stores all boxes relative to this box, which must contain the organ in all its shapes.
    const btVector3 air(kAir, kAir, kAir);
    low_ -= air;
    high_ += air;
    tree_.build(&mesh_->view(), true, low_, high_);
  }

  void update(const SharedVertices& vertices) override {
    vertices_ = vertices.get();
    mesh_->show(*vertices);
    tree_.refit(&mesh_->view(), low_, high_);
  }

  void query(const VolumeQuery& query, std::vector<std::uint32_t>& faces) override {
    const Eigen::AlignedBox3d tool = box_within_organ(query);
    faces.clear();
    Collector collector(faces);
    tree_.reportAabbOverlappingNodex(&collector, bullet_vector(tool.min()),
                                     bullet_vector(tool.max()));
    keep_faces_that_meet(query, *organ_, *vertices_, faces);
  }

 private:
  static constexpr btScalar kAir = 0.05F;  // [m]

  const OrganSurface* organ_ = nullptr;
  const std::vector<float>* vertices_ = nullptr;
  std::optional<BulletMesh> mesh_;
  btVector3 low_, high_;
  btOptimizedBvh tree_;
};

}  // namespace

std::unique_ptr<Engine> make_bullet_quantized() { return std::make_unique<BulletQuantized>(); }

}  // namespace organ_collision::bench
