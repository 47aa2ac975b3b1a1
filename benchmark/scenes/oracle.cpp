#include "oracle.hpp"

#include <algorithm>

#include "test/picking/volumes/clip_oracle.hpp"

namespace organ_collision::bench {
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

bool contains(const std::vector<std::uint32_t>& sorted, std::uint32_t face) {
  return std::binary_search(sorted.begin(), sorted.end(), face);
}

}  // namespace

Answer brute_force_answer(const VolumeQuery& query, const OrganSurface& organ,
                          const std::vector<float>& vertices) {
  const std::vector<std::uint32_t> codes = outcodes(query, vertices);
  Answer answer;
  for (std::uint32_t face = 0; face < organ.face_count(); ++face) {
    const std::uint32_t* corner = &organ.triangles[3 * face];
    if (codes[corner[0]] & codes[corner[1]] & codes[corner[2]]) continue;
    switch (verdict(query.volume, corners(organ, vertices, face), kBand)) {
      case Verdict::kIn:
        answer.faces.push_back(face);
        break;
      case Verdict::kClose:
        answer.close.push_back(face);
        break;
      case Verdict::kOut:
        break;
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
