#pragma once

#include <cstdint>
#include <vector>

#include "organ_surface.hpp"
#include "volume_query.hpp"

namespace organ_collision::bench {

/// The reference answer to a query. Both lists are sorted.
struct Answer {
  std::vector<std::uint32_t> faces;  ///< faces that certainly meet the volume
  std::vector<std::uint32_t> close;  ///< too close to the boundary for 32 bits: may be found or not
};

/// Clips every face in double precision.
Answer brute_force_answer(const VolumeQuery& query, const OrganSurface& organ,
                          const std::vector<float>& vertices);

/// The errors in an engine's answer.
struct Errors {
  std::size_t missed = 0;  ///< faces that meet the volume and were not found
  std::size_t wrong = 0;   ///< faces found that do not meet the volume, or found twice
};

/// `found` must be sorted.
Errors compare(const std::vector<std::uint32_t>& found, const Answer& answer);

}  // namespace organ_collision::bench
