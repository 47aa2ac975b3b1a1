#pragma once

#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>

#include "benchmark/scenes/organ_surface.hpp"

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

}  // namespace organ_collision::bench
