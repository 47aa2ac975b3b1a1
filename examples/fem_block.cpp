#include "fem_block.hpp"

// GCC 12 warns of code in Bullet's headers wherever it inlines this code.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableLinearElasticityForce.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;
using Tetrahedron = std::array<std::uint32_t, 4>;

const Vector3i kCells(8, 7, 3);             // [1]
const Vector3d kSize(0.12, 0.10, 0.04);     // [m]
constexpr double kDensity = 1000.0;         // [kg/m^3]
constexpr double kYoungsModulus = 12000.0;  // [Pa]
constexpr double kPoissonRatio = 0.4;       // [1]
constexpr double kMassDamping = 4.0;        // [1/s]
constexpr double kStiffnessDamping = 0.01;  // [s]

constexpr double kLongestSubstep = 0.002;  // [s] for which the explicit integration is stable

btVector3 to_bullet(const Vector3d& v) { return btVector3(v.x(), v.y(), v.z()); }
Vector3d to_eigen(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

struct Grid {
  std::vector<Vector3d> nodes;
  std::vector<Tetrahedron> tetrahedra;
};

/// [m^3] The volume. It is negative if two corners are swapped.
double volume_of(const Tetrahedron& t, const std::vector<Vector3d>& nodes) {
  const Vector3d& a = nodes[t[0]];
  return (nodes[t[1]] - a).cross(nodes[t[2]] - a).dot(nodes[t[3]] - a) / 6.0;
}

const Vector3i kNodes = kCells + Vector3i::Ones();

std::uint32_t number_of(const Vector3i& at) {
  return (at.z() * kNodes.y() + at.y()) * kNodes.x() + at.x();
}

/// Cuts each cell into six tetrahedra around its diagonal (Kuhn): one for each order of the axes.
/// The diagonals of neighbouring cells fit together.
Grid make_grid() {
  Grid grid;
  std::vector<Vector3i> lows;  // the lowest corners of the cells
  for (int node = 0; node < kNodes.prod(); ++node) {
    const int row = node / kNodes.x();
    const Vector3i at(node % kNodes.x(), row % kNodes.y(), row / kNodes.y());
    const Vector3d share = at.cast<double>().cwiseQuotient(kCells.cast<double>());
    grid.nodes.emplace_back(kSize.cwiseProduct(share - Vector3d(0.5, 0.5, 1.0)));
    if ((at.array() < kCells.array()).all()) lows.push_back(at);
  }
  for (const Vector3i& low : lows) {
    std::array<int, 3> axes = {0, 1, 2};
    do {
      Vector3i at = low;
      Tetrahedron corners = {number_of(low)};
      for (int k = 0; k < 3; ++k) {
        ++at[axes[k]];
        corners[k + 1] = number_of(at);
      }
      // Bullet needs tetrahedra of positive volume.
      if (volume_of(corners, grid.nodes) < 0.0) std::swap(corners[2], corners[3]);
      grid.tetrahedra.push_back(corners);
    } while (std::next_permutation(axes.begin(), axes.end()));
  }
  return grid;
}

/// The faces that belong to one tetrahedron only, oriented away from it.
std::vector<FaceIndices> surface_of(const Grid& grid) {
  std::map<FaceIndices, FaceIndices> faces;  // by the sorted corners
  for (const Tetrahedron& corners : grid.tetrahedra) {
    for (int opposite = 0; opposite < 4; ++opposite) {
      FaceIndices face = {corners[(opposite + 1) % 4], corners[(opposite + 2) % 4],
                          corners[(opposite + 3) % 4]};
      const Vector3d a = grid.nodes[face[0]], b = grid.nodes[face[1]], c = grid.nodes[face[2]];
      if ((b - a).cross(c - a).dot(grid.nodes[corners[opposite]] - a) > 0.0) {
        std::swap(face[1], face[2]);
      }
      FaceIndices sorted = face;
      std::sort(sorted.begin(), sorted.end());
      const auto [other, is_new] = faces.insert({sorted, face});
      if (!is_new) faces.erase(other);
    }
  }
  std::vector<FaceIndices> surface;
  for (const auto& [sorted, face] : faces) surface.push_back(face);
  return surface;
}

/// The state of a tetrahedron at rest.
btSoftBody::TetraScratch undeformed() {
  btSoftBody::TetraScratch scratch;
  scratch.m_F.setIdentity();
  scratch.m_cofF.setIdentity();
  scratch.m_corotation.setIdentity();
  scratch.m_trace = 3.0F;
  scratch.m_J = 1.0F;
  return scratch;
}

}  // namespace

struct FemBlock::World {
  explicit World(const Grid& grid)
      : body(&world.getWorldInfo(), static_cast<int>(grid.nodes.size()), nullptr, nullptr) {
    constraints.setDeformableSolver(&solver);
    world.setImplicit(false);
    world.setGravity(btVector3(0.0F, 0.0F, 0.0F));  // the shape at rest already includes gravity
    std::vector<double> masses(grid.nodes.size(), 0.0);  // [kg]
    for (const Tetrahedron& t : grid.tetrahedra) {
      const double quarter = 0.25 * kDensity * volume_of(t, grid.nodes);
      for (const std::uint32_t corner : t) masses[corner] += quarter;
    }
    for (std::size_t i = 0; i < grid.nodes.size(); ++i) {
      btSoftBody::Node& node = body.m_nodes[static_cast<int>(i)];
      node.m_x = node.m_q = to_bullet(grid.nodes[i]);
      const bool is_held = grid.nodes[i].z() < -0.999 * kSize.z();
      body.setMass(static_cast<int>(i), is_held ? 0.0F : static_cast<btScalar>(masses[i]));
    }
    for (const Tetrahedron& t : grid.tetrahedra) body.appendTetra(t[0], t[1], t[2], t[3]);
    body.initializeDmInverse();
    body.m_tetraScratches.resize(body.m_tetras.size(), undeformed());
    body.m_tetraScratchesTn.resize(body.m_tetras.size(), undeformed());
    body.m_cfg.collisions = 0;
    body.setSelfCollision(false);
    body.setActivationState(DISABLE_DEACTIVATION);
    elasticity.setYoungsModulus(kYoungsModulus);
    elasticity.setPoissonRatio(kPoissonRatio);
    world.addSoftBody(&body);
    world.addForce(&body, &elasticity);
  }
  ~World() {
    world.removeForce(&body, &elasticity);
    world.removeSoftBody(&body);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btDeformableBodySolver solver;
  btDeformableMultiBodyConstraintSolver constraints;
  btDeformableMultiBodyDynamicsWorld world{&dispatcher, &broadphase, &constraints, &configuration,
                                           &solver};
  btDeformableLinearElasticityForce elasticity{1.0F, 1.0F, kMassDamping, kStiffnessDamping};
  btSoftBody body;
};

FemBlock::FemBlock() {
  const Grid grid = make_grid();
  faces_ = surface_of(grid);
  world_ = std::make_unique<World>(grid);
}

FemBlock::~FemBlock() = default;

std::size_t FemBlock::vertex_count() const { return world_->body.m_nodes.size(); }

std::vector<float> FemBlock::vertices() const {
  std::vector<float> result;
  result.reserve(3 * vertex_count());
  for (int i = 0; i < world_->body.m_nodes.size(); ++i) {
    const btVector3& x = world_->body.m_nodes[i].m_x;
    result.insert(result.end(), {x.x(), x.y(), x.z()});
  }
  return result;
}

FemBlock::Impulse FemBlock::push(std::size_t node, const Vector3d& force, double seconds) {
  if (node >= vertex_count()) throw std::out_of_range("no node " + std::to_string(node));
  btSoftBody::Node& at = world_->body.m_nodes[static_cast<int>(node)];
  if (at.m_im == 0.0F) return {};
  const Vector3d before = to_eigen(at.m_v);
  at.m_v += to_bullet(seconds * force) * at.m_im;
  const Vector3d impulse = (to_eigen(at.m_v) - before) / at.m_im;
  return {impulse, to_eigen(at.m_x).cross(impulse)};
}

void FemBlock::step(double seconds) {
  const int substeps = static_cast<int>(std::ceil(seconds / kLongestSubstep - 1e-9));
  for (int i = 0; i < substeps; ++i) {
    world_->world.stepSimulation(static_cast<btScalar>(seconds / substeps), 0);
  }
}

}  // namespace organ_collision
