#include "around_finder.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

// What a search may cost, in planes that are looked at. The distance of a face costs as much as
// some tens of planes, and each face that is found makes the answer longer.
constexpr std::size_t kMostWork = 8'000, kMeasured = 20, kFound = 100;

}  // namespace

double AroundFinder::find(const Step& step, double nearest, double farthest,
                          std::vector<FaceContact>& faces) {
  work_ = 0;
  // The distance that is searched shrinks with the work, so that it is complete in the end.
  const auto reach = [&] {
    const double left = 1.0 - static_cast<double>(std::min(work_, kMostWork)) / kMostWork;
    return std::max(nearest, nearest + left * (farthest - nearest));
  };
  const auto begin = static_cast<std::ptrdiff_t>(faces.size());
  std::int32_t link = kShaft - 1;
  for_each_part(step, [&](const ToolPart& tool_part, const LegSpan& span) {
    const PartOnLeg part(step, span, tool_part);
    const OrganMotion organ = step.organ_motion(span);
    if (std::exchange(link, tool_part.link) != tool_part.link) planes_.clear();
    last_ = 0;
    const auto is_box_covered = [&](const BlockBoxes::Box& box) {
      const Vector3d low = box.min.head<3>().matrix().cast<double>();
      const Vector3d high = box.max.head<3>().matrix().cast<double>();
      const Vector3d center = 0.5 * (low + high), half = 0.5 * (high - low);
      return is_covered(
          [&](const Vector3d& normal) { return normal.dot(center) - normal.cwiseAbs().dot(half); });
    };
    const auto add = [&](std::uint32_t number) {
      const Triangle face = organ.after().triangle(number);
      if (is_covered([&](const Vector3d& normal) { return project_onto(normal, face).low; }))
        return true;
      work_ += kMeasured;
      const double bound = reach() + part->radius();
      const auto closest = part->closest_at_start(face, bound);
      if (!closest || closest->distance > bound) return true;
      work_ += kFound;
      const double distance = closest->distance - part->radius();
      faces.push_back(contact_on(step, span.begin, *part, number, {0.0, *closest}));
      faces.back().depth = -distance;
      if (closest->distance <= tolerance::kPierced) return true;  // It covers nothing.
      const Vector3d normal = closest->separation.normalized();
      const double beyond = closest->distance - (1.0 - kCovered) * std::max(0.0, distance);
      planes_.push_back({normal, part->support_at_start(normal, *closest) + beyond});
      return true;
    };
    search_.visit(
        organ, part->bounds(), [&] { return reach() + part->radius(); }, is_box_covered, add);
  });
  std::sort(faces.begin() + begin, faces.end(), [](const FaceContact& a, const FaceContact& b) {
    return std::tie(a.link, b.depth, a.face) < std::tie(b.link, a.depth, b.face);
  });
  return reach();
}

template <typename Low>
bool AroundFinder::is_covered(const Low& low) {
  const auto covers = [&](const Plane& plane) {
    ++work_;
    return low(plane.normal) > plane.offset;
  };
  if (last_ < planes_.size() && covers(planes_[last_])) return true;
  const auto found = std::find_if(planes_.begin(), planes_.end(), covers);
  if (found == planes_.end()) return false;
  last_ = static_cast<std::size_t>(found - planes_.begin());
  return true;
}

}  // namespace organ_collision
