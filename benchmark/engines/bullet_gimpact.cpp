#include <BulletCollision/Gimpact/btGImpactShape.h>

#include <optional>

#include "bullet_mesh.hpp"
#include "engine.hpp"
#include "exact_clip.hpp"

namespace organ_collision::bench {
namespace {

class BulletGimpact : public Engine {
 public:
  void set_topology(const OrganSurface& organ, const std::vector<float>& rest) override {
    organ_ = &organ;
    mesh_.emplace(organ, rest);
    shape_.emplace(&mesh_->view(), 0);
    shape_->updateBound();
  }

  void update(const SharedVertices& vertices) override {
    vertices_ = vertices.get();
    mesh_->show(*vertices);
    shape_->postUpdate();
    shape_->updateBound();
  }

  void query(const VolumeQuery& query, std::vector<std::uint32_t>& faces) override {
    const Eigen::AlignedBox3d tool = box_within_organ(query);
    btAABB box;
    box.m_min = bullet_vector(tool.min());
    box.m_max = bullet_vector(tool.max());
    found_.resize(0);
    shape_->getBoxSet()->boxQuery(box, found_);
    faces.clear();
    for (int i = 0; i < found_.size(); ++i) faces.push_back(static_cast<std::uint32_t>(found_[i]));
    keep_faces_that_meet(query, *organ_, *vertices_, faces);
  }

 private:
  const OrganSurface* organ_ = nullptr;
  const std::vector<float>* vertices_ = nullptr;
  std::optional<BulletMesh> mesh_;
  std::optional<btGImpactMeshShapePart> shape_;
  btAlignedObjectArray<int> found_;
};

}  // namespace

std::unique_ptr<Engine> make_bullet_gimpact() { return std::make_unique<BulletGimpact>(); }

}  // namespace organ_collision::bench
