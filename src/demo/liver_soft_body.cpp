#include "liver_soft_body.hpp"

#include <BulletSoftBody/btSoftBody.h>

#include <cmath>

namespace organ_collision {
namespace {

using Eigen::Vector3d;

constexpr double kMass = 1.5;              // [kg]
constexpr double kLongestSubstep = 0.004;  // [s]
constexpr double kBreathPeriod = 4.0;      // [s]
const Vector3d kBreath{0.0, -0.006,
                       0.002};  // [m] displacement when inhaled: towards the feet and the front

btVector3 to_bullet(const Vector3d& v) { return btVector3(v.x(), v.y(), v.z()); }

/// Whether a ligament holds this place: on the upper part of the back of the right lobe.
bool is_held(const Vector3d& rest) { return rest.x() < 0.03 && rest.y() > 0.015 && rest.z() < 0.0; }

}  // namespace

LiverSoftBody::LiverSoftBody(const ClosedSurface& surface)
    : world_(std::make_unique<btSoftBodyWorldInfo>()) {
  world_->m_gravity.setZero();  // the shape at rest already includes gravity
  world_->m_sparsesdf.Initialize();
  btAlignedObjectArray<btVector3> positions;
  for (const Vector3d& vertex : surface.vertices) positions.push_back(to_bullet(vertex));
  body_ = std::make_unique<btSoftBody>(world_.get(), positions.size(), &positions[0], nullptr);
  for (const FaceIndices& face : surface.faces) {
    for (int k = 0; k < 3; ++k) body_->appendLink(face[k], face[(k + 1) % 3], nullptr, true);
    body_->appendFace(face[0], face[1], face[2]);
  }
  body_->m_materials[0]->m_kLST = 0.2;  // [1] stiffness of the edges
  body_->m_cfg.piterations = 4;
  body_->m_cfg.kDP = 0.04;   // [1] share of the velocity lost in a substep
  body_->m_cfg.kMT = 0.008;  // [1] share of the deformation undone in a substep
  body_->m_cfg.kVC = 1e6;    // [Pa/m^3] pressure against a loss of volume
  body_->setTotalMass(kMass);
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    if (!is_held(surface.vertices[i])) continue;
    body_->setMass(i, 0.0);
    ligaments_.push_back({static_cast<int>(i), surface.vertices[i]});
  }
  body_->setPose(true, true);
}

LiverSoftBody::~LiverSoftBody() = default;

void LiverSoftBody::step(double seconds, const std::vector<TissuePush>& pushes,
                         const std::vector<VertexPush>& vertex_pushes) {
  give_way(pushes, vertex_pushes);
  const int substeps = std::ceil(seconds / kLongestSubstep - 1e-9);
  for (int i = 0; i < substeps; ++i) {
    time_ += seconds / substeps;
    breathe();
    body_->predictMotion(seconds / substeps);
    body_->solveConstraints();
    body_->integrateMotion();
  }
}

std::vector<float> LiverSoftBody::vertices() const {
  std::vector<float> result;
  result.reserve(3 * body_->m_nodes.size());
  for (int i = 0; i < body_->m_nodes.size(); ++i) {
    const btVector3& x = body_->m_nodes[i].m_x;
    for (int axis = 0; axis < 3; ++axis) result.push_back(x[axis]);
  }
  return result;
}

void LiverSoftBody::give_way(const std::vector<TissuePush>& pushes,
                             const std::vector<VertexPush>& vertex_pushes) {
  std::vector<Vector3d> sum(body_->m_nodes.size(), Vector3d::Zero());
  std::vector<int> count(body_->m_nodes.size(), 0);
  for (const TissuePush& push : pushes) {
    const btSoftBody::Face& face = body_->m_faces[push.face];
    for (int k = 0; k < 3; ++k) {  // with these weights, the pushed place moves by the displacement
      const auto node = face.m_n[k] - &body_->m_nodes[0];
      sum[node] += push.barycentric[k] / push.barycentric.squaredNorm() * push.displacement;
      ++count[node];
    }
  }
  for (const VertexPush& push : vertex_pushes) {
    sum[push.vertex] += push.displacement;
    ++count[push.vertex];
  }
  for (int i = 0; i < body_->m_nodes.size(); ++i) {
    btSoftBody::Node& node = body_->m_nodes[i];
    if (count[i] == 0 || node.m_im == 0.0) continue;
    const btVector3 shift = to_bullet(sum[i] / count[i]);
    node.m_x += shift;
    // The tool blocks the tissue: it cannot move back against the displacement.
    const btScalar back = node.m_v.dot(shift);
    if (back < 0.0 && shift.length2() > 0.0) node.m_v -= back / shift.length2() * shift;
  }
}

void LiverSoftBody::breathe() {
  const double inspired = 0.5 - 0.5 * std::cos(2.0 * M_PI * time_ / kBreathPeriod);
  for (const Ligament& ligament : ligaments_) {
    body_->m_nodes[ligament.node].m_x = to_bullet(ligament.rest + inspired * kBreath);
  }
}

}  // namespace organ_collision
