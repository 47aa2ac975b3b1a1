#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "deformable_organ.hpp"

namespace organ_collision {

// What users are told about an organ.

/// "closed", "open (12 edges)", or "not yet known". An edge is open if it has no opposite.
std::string closedness(const OrganSurface& surface);
/// "outward" or "inward" for a closed surface, otherwise "none". "not yet known" if it is not
/// found.
std::string orientation(const OrganSurface& surface);
/// For example "organ 'kidney': 2208 faces, closed, 0.12 x 0.09 x 0.06 m".
std::string summary(const std::string& organ, const OrganSurface& surface);
/// Whole sentences about what is legal, but probably a mistake: the organ's size, and faces that
/// point inward. `box`: around the organ [m].
std::vector<std::string> doubts(const std::string& organ, const Eigen::AlignedBox3d& box,
                                const OrganSurface& surface);

/// Tells the user in the log which surfaces came.
class SurfaceLog {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// An organ whose triangles change all the time, as in cutting, is told about at most once in
  /// this time. The same holds for what is doubtful about it.
  static constexpr std::chrono::seconds kPeriod{5};

  /// Logs the summary of a surface that is found, and the doubts about it.
  void tell(const std::string& organ, const OrganSurface& surface, Time now);

 private:
  struct Next {
    Time summary{}, doubts{};  ///< not before these
  };
  std::map<std::string, Next> next_;  ///< by organ
};

}  // namespace organ_collision
