#include "liver.hpp"

#include <BulletSoftBody/btSoftBody.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace organ_collision {
namespace {

using Eigen::Vector3d;

constexpr double kMass = 1.5;            // [kg]
constexpr double kLiverSubstep = 0.004;  // [s]
constexpr double kBreathPeriod = 4.0;    // [s]
/// [m] displacement when inhaled: towards the feet and the front
const Vector3d kBreath{0.0, -0.006, 0.002};

/// [m] Approximate signed distance to the surface of an ellipsoid. With f = |offset / radii|, it is
/// (f - 1) / |grad f|.
double ellipsoid(const Vector3d& point, const Vector3d& centre, const Vector3d& radii) {
  const Vector3d scaled = (point - centre).cwiseQuotient(radii);
  const double slope = scaled.cwiseQuotient(radii).norm();
  return scaled.norm() * (scaled.norm() - 1.0) / std::max(slope, 1e-9);
}

/// The minimum of two levels, smoothed where they differ by less than about `blend`.
double smooth_min(double a, double b, double blend) {
  return -blend * std::log(std::exp(-a / blend) + std::exp(-b / blend));
}

double carve(double a, double b, double blend) { return -smooth_min(-a, b, blend); }

/// Interpolates between the level functions of an ellipsoid (morph 0) and of the liver (morph 1).
double morphed_level(const Vector3d& point, double morph) {
  const double egg = ellipsoid(point, {0.0, 0.01, 0.002}, {0.11, 0.055, 0.025});
  return (1.0 - morph) * egg + morph * liver_level(point);
}

Vector3d gradient(const Vector3d& point, double morph) {
  constexpr double kStep = 1e-6;
  Vector3d result;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d step = kStep * Vector3d::Unit(axis);
    result[axis] = morphed_level(point + step, morph) - morphed_level(point - step, morph);
  }
  return result / (2.0 * kStep);
}

/// Moves the point onto the morphed surface, by Newton's method along the gradient.
Vector3d onto_surface(Vector3d point, double morph) {
  for (int i = 0; i < 2; ++i) {
    const Vector3d slope = gradient(point, morph);
    point -= morphed_level(point, morph) * slope / std::max(slope.squaredNorm(), 0.2);
  }
  return point;
}

/// The surface of a box around the origin that consists of cubic cells with edge 1.
ClosedSurface make_lattice_box(const std::array<int, 3>& cells) {
  ClosedSurface box;
  std::map<std::array<int, 3>, std::uint32_t> index_of;
  const auto index = [&](const std::array<int, 3>& place) {
    const auto [found, is_new] = index_of.try_emplace(place, box.vertices.size());
    if (is_new) {
      box.vertices.emplace_back(place[0] - 0.5 * cells[0], place[1] - 0.5 * cells[1],
                                place[2] - 0.5 * cells[2]);
    }
    return found->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const int side : {0, cells[axis]}) {
      for (int i = 0; i < cells[u]; ++i) {
        for (int j = 0; j < cells[v]; ++j) {
          std::array<std::uint32_t, 4> corner;
          for (int k = 0; k < 4; ++k) {  // counterclockwise, seen against the axis
            std::array<int, 3> place;
            place[axis] = side;
            place[u] = i + (k == 1 || k == 2);
            place[v] = j + (k >= 2);
            corner[k] = index(place);
          }
          if (side == 0) std::swap(corner[1], corner[3]);
          box.faces.push_back({corner[0], corner[1], corner[2]});
          box.faces.push_back({corner[0], corner[2], corner[3]});
        }
      }
    }
  }
  return box;
}

/// Makes the triangles about equally large. In each round, moves each vertex to the mean centre of
/// the triangles around it, weighted by their areas, and back onto the surface.
void even_out(ClosedSurface& surface, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    const double morph = std::min(1.0, 2.0 * round / rounds);
    std::vector<Vector3d> sum(surface.vertices.size(), Vector3d::Zero());
    std::vector<double> weight(surface.vertices.size(), 0.0);
    for (std::size_t i = 0; i < surface.faces.size(); ++i) {
      const Triangle corners = surface.triangle(i);
      const double area = (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
      for (const std::uint32_t vertex : surface.faces[i]) {
        sum[vertex] += area * (corners[0] + corners[1] + corners[2]) / 3.0;
        weight[vertex] += area;
      }
    }
    for (std::size_t i = 0; i < sum.size(); ++i) {
      const Vector3d normal = gradient(surface.vertices[i], morph).normalized();
      const Vector3d shift = sum[i] / weight[i] - surface.vertices[i];
      surface.vertices[i] += shift - normal.dot(shift) * normal;
      surface.vertices[i] = onto_surface(surface.vertices[i], morph);
    }
  }
}

btVector3 bullet_vector(const Vector3d& v) { return btVector3(v.x(), v.y(), v.z()); }

/// Whether a ligament holds this place: on the upper part of the back of the right lobe.
bool is_held(const Vector3d& rest) { return rest.x() < 0.03 && rest.y() > 0.015 && rest.z() < 0.0; }

/// A sine with a period of `period` seconds.
double wave(double seconds, double period) { return std::sin(2.0 * M_PI * seconds / period); }

/// [m] The z coordinate of the front of the resting liver at (x, y), by bisection.
double front_of_liver(double x, double y) {
  double inside = 0.0, outside = 0.1;
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (inside + outside);
    (liver_level({x, y, middle}) < 0.0 ? inside : outside) = middle;
  }
  return inside;
}

Vector3d palpator_tip(double seconds) {
  constexpr double kLift = 0.003, kPress = 0.022;  // [m] from first touch upwards and downwards
  const double x = -0.045 + 0.022 * wave(seconds, 11.0);
  const double y = -0.004 + 0.020 * wave(seconds, 7.0);
  const double press = 0.5 - 0.5 * wave(seconds + 0.75, 3.0);
  return {x, y, front_of_liver(x, y) + kToolRadius + kLift - press * (kLift + kPress)};
}

/// 0 if the tool is in front of the lobe, 1 if it is behind it. It passes through the lobe at each
/// full second.
double stab_progress(double seconds) {
  const double second = std::floor(seconds);
  const double share = std::min((seconds - second) / kStabDuration, 1.0);
  const bool forth = std::fmod(second, 2.0) == 1.0;
  if (second < 1.0) return 0.0;
  return forth ? share : 1.0 - share;
}

Vector3d stabber_tip(double seconds) {
  const Vector3d in_front{0.068, 0.030, 0.052}, behind{0.068, 0.030, -0.056};
  const Vector3d sway{0.010 * wave(seconds, 6.5), 0.0, 0.0};
  return in_front + stab_progress(seconds) * (behind - in_front) + sway;
}

}  // namespace

double liver_level(const Vector3d& point) {
  const double right_lobe = ellipsoid(point, {-0.042, -0.006, 0.0}, {0.056, 0.062, 0.036});
  const double middle = ellipsoid(point, {-0.006, 0.014, 0.003}, {0.060, 0.046, 0.027});
  const double left_lobe = ellipsoid(point, {0.050, 0.017, 0.006}, {0.070, 0.032, 0.013});
  const double hollow_underneath =
      ellipsoid(point, {-0.004, -0.012, -0.052}, {0.034, 0.050, 0.042});
  const double fissure = ellipsoid(point, {0.024, -0.052, 0.0}, {0.016, 0.040, 0.060});
  double level = smooth_min(smooth_min(right_lobe, middle, 0.006), left_lobe, 0.007);
  level = carve(level, hollow_underneath, 0.006);
  return carve(level, fissure, 0.006);
}

ClosedSurface make_liver_surface() {
  ClosedSurface surface = make_lattice_box({19, 10, 4});
  for (Vector3d& vertex : surface.vertices) vertex *= 0.011;
  even_out(surface, 80);
  return surface;
}

CutSurface cut_off(const ClosedSurface& whole, const Eigen::Hyperplane<double, 3>& plane) {
  CutSurface left;
  std::map<std::uint32_t, std::uint32_t> number_of;
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const FaceIndices& face : whole.faces) {
    const auto is_left = [&](std::uint32_t vertex) {
      return plane.signedDistance(whole.vertices[vertex]) < 0.0;
    };
    if (std::none_of(face.begin(), face.end(), is_left)) continue;
    FaceIndices& own = left.surface.faces.emplace_back();
    for (int k = 0; k < 3; ++k) {
      const Vector3d& place = whole.vertices[face[k]];
      const auto [number, is_new] = number_of.try_emplace(face[k], left.origins.size());
      own[k] = number->second;
      if (!is_new) continue;
      left.origins.push_back(face[k]);
      left.surface.vertices.push_back(is_left(face[k]) ? place : plane.projection(place));
    }
    for (int k = 0; k < 3; ++k) edges.emplace(own[k], own[(k + 1) % 3]);
  }
  Vector3d rim = Vector3d::Zero();
  const auto centre = static_cast<std::uint32_t>(left.origins.size());
  const std::size_t faces = left.surface.faces.size();
  for (const auto& [from, to] : edges) {
    if (edges.count({to, from}) > 0) continue;
    left.surface.faces.push_back({to, from, centre});
    left.origins.resize(centre + 1, left.origins[from]);
    rim += left.surface.vertices[from];
  }
  left.surface.vertices.emplace_back(rim / static_cast<double>(left.surface.faces.size() - faces));
  return left;
}

LiverSoftBody::LiverSoftBody(ClosedSurface surface)
    : surface_(std::move(surface)), world_(std::make_unique<btSoftBodyWorldInfo>()) {
  world_->m_gravity.setZero();  // the shape at rest already includes gravity
  world_->m_sparsesdf.Initialize();
  btAlignedObjectArray<btVector3> positions;
  for (const Vector3d& vertex : surface_.vertices) positions.push_back(bullet_vector(vertex));
  body_ = std::make_unique<btSoftBody>(world_.get(), positions.size(), &positions[0], nullptr);
  for (const FaceIndices& face : surface_.faces) {
    for (int k = 0; k < 3; ++k) body_->appendLink(face[k], face[(k + 1) % 3], nullptr, true);
    body_->appendFace(face[0], face[1], face[2]);
  }
  body_->m_materials[0]->m_kLST = 0.2;  // [1] stiffness of the edges
  body_->m_cfg.piterations = 4;
  body_->m_cfg.kDP = 0.04;   // [1] share of the velocity lost in a substep
  body_->m_cfg.kMT = 0.008;  // [1] share of the deformation undone in a substep
  body_->m_cfg.kVC = 1e6;    // [Pa/m^3] pressure against a loss of volume
  body_->setTotalMass(kMass);
  for (std::size_t i = 0; i < surface_.vertices.size(); ++i) {
    if (!is_held(surface_.vertices[i])) continue;
    body_->setMass(i, 0.0);
    ligaments_.push_back({static_cast<int>(i), surface_.vertices[i]});
  }
  body_->setPose(true, true);
}

LiverSoftBody::~LiverSoftBody() = default;

void LiverSoftBody::cut(const Eigen::Hyperplane<double, 3>& plane) {
  const CutSurface cut = cut_off(surface_, plane);
  LiverSoftBody left(cut.surface);
  for (std::size_t i = 0; i < cut.origins.size(); ++i) {
    const btSoftBody::Node& origin = body_->m_nodes[cut.origins[i]];
    btSoftBody::Node& node = left.body_->m_nodes[i];
    node.m_x += origin.m_x - bullet_vector(surface_.vertices[cut.origins[i]]);
    node.m_v = origin.m_v;
  }
  std::swap(surface_, left.surface_);
  std::swap(world_, left.world_);
  std::swap(body_, left.body_);
  std::swap(ligaments_, left.ligaments_);
}

void LiverSoftBody::step(double seconds, const std::vector<VertexPush>& pushes) {
  give_way(pushes);
  const int substeps = std::ceil(seconds / kLiverSubstep - 1e-9);
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

void LiverSoftBody::give_way(const std::vector<VertexPush>& pushes) {
  std::vector<Vector3d> sum(body_->m_nodes.size(), Vector3d::Zero());
  std::vector<int> count(body_->m_nodes.size(), 0);
  for (const VertexPush& push : pushes) {
    sum[push.vertex] += push.displacement;
    ++count[push.vertex];
  }
  for (int i = 0; i < body_->m_nodes.size(); ++i) {
    btSoftBody::Node& node = body_->m_nodes[i];
    if (count[i] == 0 || node.m_im == 0.0) continue;
    const btVector3 shift = bullet_vector(sum[i] / count[i]);
    node.m_x += shift;
    // The tool blocks the tissue: it cannot move back against the displacement.
    const btScalar back = node.m_v.dot(shift);
    if (back < 0.0 && shift.length2() > 0.0) node.m_v -= back / shift.length2() * shift;
  }
}

void LiverSoftBody::breathe() {
  const double inspired = 0.5 - 0.5 * std::cos(2.0 * M_PI * time_ / kBreathPeriod);
  for (const Ligament& ligament : ligaments_) {
    body_->m_nodes[ligament.node].m_x = bullet_vector(ligament.rest + inspired * kBreath);
  }
}

const ScriptedTool kPalpator{"palpator", {-0.075, -0.100, 0.150}, palpator_tip};
const ScriptedTool kStabber{"stabber", {0.095, -0.130, 0.040}, stabber_tip};

}  // namespace organ_collision
