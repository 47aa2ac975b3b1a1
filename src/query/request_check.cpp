#include "request_check.hpp"

#include <sstream>
#include <stdexcept>

#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {
namespace {

template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream message;
  (message << ... << parts);
  throw std::invalid_argument(message.str());
}

void check_point(const char* name, std::size_t waypoint, const Eigen::Vector3d& point) {
  // NaN is within nothing.
  if ((point.array().abs() <= tolerance::kFarthest).all()) return;
  refuse(name, " of waypoint ", waypoint, " is (", point.x(), ", ", point.y(), ", ", point.z(),
         "); must be finite and within ", tolerance::kFarthest, " m");
}

void check_path(const ToolPath& path) {
  if (path.empty()) refuse("the tool's path is empty; it has at least one waypoint");
  for (std::size_t i = 0; i < path.size(); ++i) {
    check_point("trocar", i, path[i].axis.trocar);
    check_point("tip", i, path[i].axis.tip);
    if (i > 0 && !(path[i].fraction > path[i - 1].fraction)) {
      refuse("waypoint ", i, " is at fraction ", path[i].fraction, " after ", path[i - 1].fraction,
             "; fractions must rise");
    }
  }
  if (path.size() > 1 && (path.front().fraction != 0.0 || path.back().fraction != 1.0)) {
    refuse("the path runs from fraction ", path.front().fraction, " to ", path.back().fraction,
           "; must be from 0 to 1");
  }
}

bool needs_resting_trocar(QueryMode mode) {
  return mode == QueryMode::kPaperSwept || mode == QueryMode::kPaperNaive;
}

}  // namespace

void check(const CollisionRequest& request) {
  if (!request.organ) refuse("the request names no organ");
  if (!(request.radius > 0.0 && request.radius <= tolerance::kFarthest)) {
    refuse("radius is ", request.radius, " m; must be positive, finite and within ",
           tolerance::kFarthest, " m");
  }
  if (request.mode > QueryMode::kPaperNaive) {
    refuse("mode is ", static_cast<int>(request.mode), "; legal are 0 to 4");
  }
  check_path(request.path);
  if (needs_resting_trocar(request.mode) &&
      request.path.front().axis.trocar != request.path.back().axis.trocar) {
    refuse("the trocar moves by ",
           (request.path.back().axis.trocar - request.path.front().axis.trocar).norm(),
           " m during the step; it must rest in the paper's modes");
  }
  if (request.organ_before && !request.organ_before->same_faces(*request.organ)) {
    refuse("the organ's earlier shape has ", request.organ_before->face_count(),
           " other faces than the present one, which has ", request.organ->face_count());
  }
}

}  // namespace organ_collision
