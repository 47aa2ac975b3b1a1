#pragma once

#include <organ_collision/OrganMesh.h>

#include <cstddef>
#include <string>
#include <vector>

namespace organ_collision::stress {

/// A wavy square sheet of 0.1 m around the origin, with `cells` times `cells` squares of two faces.
struct Sheet {
  std::size_t cells;

  /// x y z x y z ... [m]. `phase` [rad] moves the waves on.
  std::vector<float> vertices(double phase) const;
  /// Without the first `cut` squares: a sheet that was cut has other triangles.
  std::vector<std::uint32_t> triangles(std::size_t cut) const;
};

/// A mesh message with a name and the frame of the sheets, "sheet", and the time of now.
OrganMeshPtr mesh_message(const std::string& organ, const Sheet& sheet, std::size_t cut,
                          double phase);

}  // namespace organ_collision::stress
