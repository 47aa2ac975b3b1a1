#include <BulletCollision/CollisionShapes/btOptimizedBvh.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>

#include <optional>

#include "benchmark/scenes/organ_surface.hpp"
#include "engine.hpp"
#include "exact_clip.hpp"

namespace organ_collision::bench {

inline btVector3 bullet_vector(const Eigen::Vector3d& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

/// Shows an organ to Bullet without copying its vertices.
class BulletMesh {
 public:
  BulletMesh(const OrganSurface& organ, const std::vector<float>& vertices) {
    btIndexedMesh mesh;
    mesh.m_numTriangles = static_cast<int>(organ.face_count());
    mesh.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(organ.triangles.data());
    mesh.m_triangleIndexStride = 3 * sizeof(std::uint32_t);
    mesh.m_numVertices = static_cast<int>(vertices.size() / 3);
    mesh.m_vertexBase = reinterpret_cast<const unsigned char*>(vertices.data());
    mesh.m_vertexStride = 3 * sizeof(float);
    mesh.m_vertexType = PHY_FLOAT;
    view_.addIndexedMesh(mesh, PHY_INTEGER);
  }

  void show(const std::vector<float>& vertices) {
    view_.getIndexedMeshArray()[0].m_vertexBase =
        reinterpret_cast<const unsigned char*>(vertices.data());
  }
  btTriangleIndexVertexArray& view() { return view_; }

 private:
  btTriangleIndexVertexArray view_;
};

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
