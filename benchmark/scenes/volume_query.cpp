#include "volume_query.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "picking/volumes/conservative_volume.hpp"
#include "test/proof/exact_sides.hpp"

namespace organ_collision::bench {
namespace {

using Eigen::Vector3d;

constexpr double kSame = 1e-9;  // [m] points or planes that are closer than this count as one

bool is_inside(const Vector3d& point, const std::vector<HalfSpace>& half_spaces) {
  return std::all_of(half_spaces.begin(), half_spaces.end(), [&](const HalfSpace& half_space) {
    return half_space.normal.dot(point) <= half_space.offset + kSame;
  });
}

// Three planes meet in a corner of the solid if their common point is inside all half-spaces.
void add_corner(const HalfSpace& a, const HalfSpace& b, const HalfSpace& c,
                const std::vector<HalfSpace>& half_spaces, std::vector<Vector3d>& corners) {
  Eigen::Matrix3d normals;
  normals << a.normal.transpose(), b.normal.transpose(), c.normal.transpose();
  if (std::abs(normals.determinant()) < kSame) return;
  const Vector3d point = normals.inverse() * Vector3d(a.offset, b.offset, c.offset);
  if (!is_inside(point, half_spaces)) return;
  const auto is_same = [&](const Vector3d& corner) { return (corner - point).norm() < kSame; };
  if (std::none_of(corners.begin(), corners.end(), is_same)) corners.push_back(point);
}

// The corners on one plane, sorted by angle around their centre. Empty if there are fewer than
// three.
std::vector<int> side_of(const HalfSpace& half_space, const std::vector<Vector3d>& corners) {
  std::vector<int> side;
  Vector3d centre = Vector3d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (std::abs(half_space.normal.dot(corners[i]) - half_space.offset) > 2 * kSame) continue;
    side.push_back(static_cast<int>(i));
    centre += corners[i];
  }
  if (side.size() < 3) return {};
  centre /= static_cast<double>(side.size());
  const Vector3d x = (corners[side[0]] - centre).normalized();
  const Vector3d y = half_space.normal.cross(x);
  const auto angle = [&](int i) {
    return std::atan2(y.dot(corners[i] - centre), x.dot(corners[i] - centre));
  };
  std::sort(side.begin(), side.end(), [&](int a, int b) { return angle(a) < angle(b); });
  return side;
}

}  // namespace

ConvexSolid solid_of(const std::vector<HalfSpace>& half_spaces) {
  ConvexSolid solid;
  for (std::size_t i = 0; i < half_spaces.size(); ++i) {
    for (std::size_t j = i + 1; j < half_spaces.size(); ++j) {
      for (std::size_t k = j + 1; k < half_spaces.size(); ++k) {
        add_corner(half_spaces[i], half_spaces[j], half_spaces[k], half_spaces, solid.corners);
      }
    }
  }
  for (const HalfSpace& half_space : half_spaces) {
    std::vector<int> side = side_of(half_space, solid.corners);
    const auto& known = solid.sides;
    if (side.empty() || std::find(known.begin(), known.end(), side) != known.end()) continue;
    solid.sides.push_back(std::move(side));
  }
  return solid;
}

namespace {

double extent_from_trocar(const ShaftMotion& motion, const Eigen::AlignedBox3d& organ) {
  const Eigen::Vector3d low = organ.min() - motion.start.trocar;
  const Eigen::Vector3d high = organ.max() - motion.start.trocar;
  return std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
}

std::vector<HalfSpace> half_spaces_of(const ViewingVolume& volume) {
  std::vector<HalfSpace> half_spaces;
  for (std::size_t i = 0; i < volume.half_space_count(); ++i) {
    HalfSpace half_space = volume.half_space(i);
    half_space.offset += half_space.normal.dot(volume.origin());
    half_spaces.push_back(half_space);
  }
  return half_spaces;
}

}  // namespace

VolumeQuery::VolumeQuery(const ShaftMotion& motion, double radius, const Eigen::AlignedBox3d& organ)
    : motion(motion),
      radius(radius),
      extent(extent_from_trocar(motion, organ)),
      volume(PartSweep(motion, radius).volume({0.0, extent})),
      half_spaces(half_spaces_of(volume)),
      solid(solid_of(half_spaces)),
      organ(organ) {}

namespace {

// [m] Within this distance of the boundary, clipping in 32 bits may keep a face or drop it.
constexpr double kBand = 2e-6;

/// One bit for each half-space that the vertex is outside of by more than the band.
std::vector<std::uint32_t> outcodes(const VolumeQuery& query, const std::vector<float>& vertices) {
  std::vector<std::uint32_t> codes(vertices.size() / 3, 0U);
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const Eigen::Vector3d point =
        Eigen::Map<const Eigen::Vector3f>(&vertices[3 * i]).cast<double>();
    for (std::size_t k = 0; k < query.half_spaces.size(); ++k) {
      const HalfSpace& half_space = query.half_spaces[k];
      if (half_space.normal.dot(point) > half_space.offset + kBand) codes[i] |= 1U << k;
    }
  }
  return codes;
}

/// The half-spaces of the volume, all moved outward by `growth` [m].
std::vector<HalfSpace> moved_outward(const ViewingVolume& volume, double growth) {
  std::vector<HalfSpace> half_spaces;
  for (std::size_t i = 0; i < volume.half_space_count(); ++i) {
    half_spaces.push_back(volume.half_space(i));
    half_spaces.back().offset += growth;
  }
  return half_spaces;
}

bool contains(const std::vector<std::uint32_t>& sorted, std::uint32_t face) {
  return std::binary_search(sorted.begin(), sorted.end(), face);
}

}  // namespace

Answer brute_force_answer(const VolumeQuery& query, const OrganSurface& organ,
                          const std::vector<float>& vertices) {
  const std::vector<std::uint32_t> codes = outcodes(query, vertices);
  const std::vector<HalfSpace> inner = moved_outward(query.volume, -kBand),
                               outer = moved_outward(query.volume, kBand);
  Answer answer;
  for (std::uint32_t face = 0; face < organ.face_count(); ++face) {
    const std::uint32_t* corner = &organ.triangles[3 * face];
    if (codes[corner[0]] & codes[corner[1]] & codes[corner[2]]) continue;
    const Triangle triangle = corners(organ, vertices, face);
    if (oracle::meets(triangle, query.volume.origin(), inner)) {
      answer.faces.push_back(face);
    } else if (oracle::meets(triangle, query.volume.origin(), outer)) {
      answer.close.push_back(face);
    }
  }
  return answer;
}

Errors compare(const std::vector<std::uint32_t>& found, const Answer& answer) {
  Errors errors;
  for (const std::uint32_t face : answer.faces) errors.missed += !contains(found, face);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const bool repeated = i > 0 && found[i] == found[i - 1];
    const bool meets = contains(answer.faces, found[i]) || contains(answer.close, found[i]);
    errors.wrong += repeated || !meets;
  }
  return errors;
}

}  // namespace organ_collision::bench
