#include "scan.hpp"

#include <immintrin.h>

#include <algorithm>
#include <array>

#include "engine.hpp"
#include "exact_clip.hpp"

namespace organ_collision::bench {
namespace {

constexpr double kRounding = 1e-6;  // [m] more than rounding to 32 bits moves a plane near an organ

struct Plane {
  float x, y, z, offset;
};

/// The planes of at most eight half-spaces: the first ones.
struct Planes {
  std::array<Plane, 8> plane;
  std::size_t count = 0;
};

Planes planes_of(const std::vector<HalfSpace>& half_spaces) {
  Planes planes;
  planes.count = std::min(half_spaces.size(), planes.plane.size());
  for (std::size_t k = 0; k < planes.count; ++k) {
    const Eigen::Vector3f normal = half_spaces[k].normal.cast<float>();
    planes.plane[k] = {normal.x(), normal.y(), normal.z(),
                       static_cast<float>(half_spaces[k].offset + kRounding)};
  }
  return planes;
}

void plain_outcodes(const float* xyz, std::size_t count, const Planes& planes,
                    std::uint8_t* codes) {
  for (std::size_t i = 0; i < count; ++i, xyz += 3) {
    unsigned code = 0;
    for (std::size_t k = 0; k < planes.count; ++k) {
      const Plane& p = planes.plane[k];
      code |= static_cast<unsigned>(p.x * xyz[0] + p.y * xyz[1] + p.z * xyz[2] > p.offset) << k;
    }
    codes[i] = static_cast<std::uint8_t>(code);
  }
}

#if defined(__x86_64__)

constexpr std::size_t kGroup = 32;  // number of vertices whose codes fill a register

struct Points {
  __m256 x, y, z;
};

// Loads four vertices from `low` and four from `high`.
__attribute__((target("avx2,fma"), always_inline)) inline Points load(const float* low,
                                                                      const float* high) {
  const auto both = [&](int i) __attribute__((target("avx2,fma"), always_inline)) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(low + i)),
                                _mm_loadu_ps(high + i), 1);
  };
  const __m256 a = both(0), b = both(4), c = both(8);
  const __m256 upper_xy = _mm256_shuffle_ps(b, c, _MM_SHUFFLE(2, 1, 3, 2));
  const __m256 lower_yz = _mm256_shuffle_ps(a, b, _MM_SHUFFLE(1, 0, 2, 1));
  return {_mm256_shuffle_ps(a, upper_xy, _MM_SHUFFLE(2, 0, 3, 0)),
          _mm256_shuffle_ps(lower_yz, upper_xy, _MM_SHUFFLE(3, 1, 2, 0)),
          _mm256_shuffle_ps(lower_yz, c, _MM_SHUFFLE(3, 0, 3, 1))};
}

// For each point, the signed distance to the plane, negative if the point is outside.
__attribute__((target("avx2,fma"), always_inline)) inline __m256i room(const Plane& plane,
                                                                       const Points& points) {
  __m256 room = _mm256_set1_ps(plane.offset);
  room = _mm256_fnmadd_ps(_mm256_set1_ps(plane.x), points.x, room);
  room = _mm256_fnmadd_ps(_mm256_set1_ps(plane.y), points.y, room);
  return _mm256_castps_si256(_mm256_fnmadd_ps(_mm256_set1_ps(plane.z), points.z, room));
}

// Packing with saturation keeps the sign of a float. It works on each half of a register
// separately, which is why load() interleaves two groups of vertices.
__attribute__((target("avx2,fma"))) void avx2_outcodes(const float* xyz, std::size_t groups,
                                                       const Planes& planes, std::uint8_t* codes) {
  for (std::size_t group = 0; group < groups; ++group, xyz += 3 * kGroup, codes += kGroup) {
    const float* high = xyz + 3 * kGroup / 2;
    const Points a = load(xyz, high), b = load(xyz + 12, high + 12);
    const Points c = load(xyz + 24, high + 24), d = load(xyz + 36, high + 36);
    __m256i code = _mm256_setzero_si256();
    for (std::size_t k = 0; k < planes.count; ++k) {
      const Plane& plane = planes.plane[k];
      const __m256i rooms = _mm256_packs_epi16(_mm256_packs_epi32(room(plane, a), room(plane, b)),
                                               _mm256_packs_epi32(room(plane, c), room(plane, d)));
      const __m256i outside = _mm256_cmpgt_epi8(_mm256_setzero_si256(), rooms);
      code = _mm256_or_si256(
          code, _mm256_and_si256(outside, _mm256_set1_epi8(static_cast<char>(1 << k))));
    }
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(codes), code);
  }
}

std::size_t vector_outcodes(const float* xyz, std::size_t count, const Planes& planes,
                            std::uint8_t* codes) {
  static const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (!has_avx2) return 0;
  avx2_outcodes(xyz, count / kGroup, planes, codes);
  return count / kGroup * kGroup;
}

#else

std::size_t vector_outcodes(const float*, std::size_t, const Planes&, std::uint8_t*) { return 0; }

#endif

}  // namespace

void find_outcodes(const std::vector<float>& vertices, const std::vector<HalfSpace>& half_spaces,
                   std::vector<std::uint8_t>& outcodes) {
  const std::size_t count = vertices.size() / 3;
  outcodes.resize(count);
  const Planes planes = planes_of(half_spaces);
  const std::size_t done = vector_outcodes(vertices.data(), count, planes, outcodes.data());
  plain_outcodes(vertices.data() + 3 * done, count - done, planes, outcodes.data() + done);
}

void find_survivors(const std::vector<std::uint32_t>& triangles,
                    const std::vector<std::uint8_t>& outcodes, std::vector<std::uint32_t>& faces) {
  faces.clear();
  const std::uint8_t* codes = outcodes.data();
  const std::uint32_t* corner = triangles.data();
  const auto count = static_cast<std::uint32_t>(triangles.size() / 3);
  for (std::uint32_t face = 0; face < count; ++face, corner += 3) {
    if ((codes[corner[0]] & codes[corner[1]] & codes[corner[2]]) == 0) faces.push_back(face);
  }
}

namespace {

class Scan : public Engine {
 public:
  void set_topology(const OrganSurface& organ, const std::vector<float>&) override {
    organ_ = &organ;
  }
  void update(const SharedVertices& vertices) override { vertices_ = vertices.get(); }

  void query(const VolumeQuery& query, std::vector<std::uint32_t>& faces) override {
    find_outcodes(*vertices_, query.half_spaces, outcodes_);
    find_survivors(organ_->triangles, outcodes_, survivors_);
    faces.clear();
    for (const std::uint32_t face : survivors_) {
      if (meets(corners(*organ_, *vertices_, face), query.half_spaces)) faces.push_back(face);
    }
  }

 private:
  const OrganSurface* organ_ = nullptr;
  const std::vector<float>* vertices_ = nullptr;
  std::vector<std::uint8_t> outcodes_;
  std::vector<std::uint32_t> survivors_;
};

}  // namespace

std::unique_ptr<Engine> make_scan() { return std::make_unique<Scan>(); }

}  // namespace organ_collision::bench
