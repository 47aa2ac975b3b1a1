#pragma once

#include <cstdint>
#include <vector>

#include "benchmark/engines/volume_query.hpp"
#include "organ_surface.hpp"

namespace organ_collision::bench {

/// The faces that meet a volume, by brute force in double precision.
struct Answer {
  std::vector<std::uint32_t> faces;  ///< that certainly do, by rising number
  std::vector<std::uint32_t> close;  ///< too near its boundary to say for 32-bit clipping
};

Answer oracle(const VolumeQuery& query, const OrganSurface& organ,
              const std::vector<float>& vertices);

/// What an engine got wrong.
struct Errors {
  std::size_t missed = 0;  ///< faces that meet the volume and were not found
  std::size_t wrong = 0;   ///< faces found that do not meet it, or found twice
};

/// `found`: by rising number.
Errors compare(const std::vector<std::uint32_t>& found, const Answer& answer);

}  // namespace organ_collision::bench
