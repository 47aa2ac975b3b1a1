#include "patch_finder.hpp"

#include <algorithm>
#include <tuple>

#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

// [1] How much nearer than the plane a covered face may be: a share of the clearance, which a proxy
// keeps to 1 %, and a share of the distance beyond the clearance.
constexpr double kRoughness = 0.005, kRoughnessBeyond = 0.05;

/// Whether all corners of a face are within a distance [m] of a point.
bool is_within(double distance, const Vector3d& point, const Triangle& face) {
  return std::all_of(face.begin(), face.end(), [&](const Vector3d& corner) {
    return (corner - point).squaredNorm() <= distance * distance;
  });
}

/// The closest points of a part at rest and a face. Nothing if they are farther apart than `bound`.
std::optional<ClosestPoints> measure(const MovingPart& part, bool is_convex, const FaceMotion& face,
                                     double bound) {
  if (is_convex) return closest_points(part.core().start(), face.end, bound);
  WorkBudget budget = WorkBudget::unlimited();
  const auto approach = part.closest_approach(face, bound, budget);
  if (!approach) return std::nullopt;
  return approach->closest;
}

}  // namespace

bool PatchFinder::find(const Step& step, const std::vector<Limits>& of_parts, std::size_t& tests,
                       std::vector<FaceContact>& contacts) {
  bool is_complete = true;
  for_each_part(step, [&](const ToolPart& part, const LegSpan& span) {
    const Limits& limits = of_parts[part_index(part.link)];
    if (limits.distance == 0.0) return;
    const PartOnLeg moving(step, span, part);
    const OrganMotion organ = step.organ_motion(span);
    const bool is_convex = !part.shape || !part.shape->surface;
    const double bound = limits.distance + moving->radius();
    double nearest = bound;
    patches_.clear();
    last_ = 0;
    const std::size_t left = search_.visit(
        organ, moving->bounds(), [&] { return bound; },
        [&](const BlockBoxes::Box& box) { return is_covered(box, nearest); },
        [&](std::uint32_t face) {
          const FaceMotion motion = organ.face(organ.after().faces()[face]);
          if (is_covered(motion.end, nearest)) return true;
          if (tests == 0) return false;
          --tests;
          const auto closest = measure(*moving, is_convex, motion, bound);
          if (!closest || closest->distance > bound) return true;
          nearest = std::min(nearest, closest->distance);
          patches_.emplace_back(face, *closest, *moving, is_convex, limits);
          return true;
        });
    if (left > 0) is_complete = false;
    std::sort(patches_.begin(), patches_.end(), [](const Patch& a, const Patch& b) {
      return std::tie(a.closest.distance, a.face) < std::tie(b.closest.distance, b.face);
    });
    found_.swap(patches_);
    patches_.clear();
    for (const Patch& patch : found_) {
      if (patches_.size() == kMost) break;
      const Triangle face = organ.after().triangle(patch.face);
      const bool is_covered = std::any_of(patches_.begin(), patches_.end(), [&](const Patch& of) {
        return (of.closest.on_face - patch.closest.on_face).norm() <= of.radius &&
               of.keeps_beyond(project_onto(of.normal, face).low, nearest);
      });
      if (is_covered) continue;
      patches_.push_back(patch);
      contacts.push_back(contact_on(step, span.begin, *moving, patch.face, {0.0, patch.closest}));
    }
  });
  return is_complete;
}

PatchFinder::Patch::Patch(std::uint32_t its_face, const ClosestPoints& its_closest,
                          const MovingPart& part, bool is_convex, const Limits& limits)
    : face(its_face), closest(its_closest) {
  const double distance = closest.distance - part.radius();
  radius = std::max(limits.patch, distance);
  roughness =
      kRoughness * limits.clearance + kRoughnessBeyond * std::max(0.0, distance - limits.clearance);
  if (closest.distance <= tolerance::kPierced) return;
  normal = closest.separation.normalized();
  support = is_convex ? normal.dot(closest.on_core) : part.plane(normal).support();
}

bool PatchFinder::Patch::keeps_beyond(double lowest, double nearest) const {
  const double distance = closest.distance;
  const double least = std::min(std::max(distance - roughness, nearest), distance);
  return lowest - support > least - tolerance::kPierced;
}

/// Whether a face that was found covers this one. `nearest` [m]: the smallest distance of the core
/// so far. A covered face is not nearer than that.
bool PatchFinder::is_covered(const Triangle& face, double nearest) {
  const auto covers = [&](const Patch& patch) {
    return is_within(patch.radius, patch.closest.on_face, face) &&
           patch.keeps_beyond(project_onto(patch.normal, face).low, nearest);
  };
  if (last_ < patches_.size() && covers(patches_[last_])) return true;
  const auto found = std::find_if(patches_.begin(), patches_.end(), covers);
  if (found == patches_.end()) return false;
  last_ = static_cast<std::size_t>(found - patches_.begin());
  return true;
}

/// The same for all faces in a box.
bool PatchFinder::is_covered(const BlockBoxes::Box& box, double nearest) const {
  const Vector3d low = box.min.head<3>().matrix().cast<double>();
  const Vector3d high = box.max.head<3>().matrix().cast<double>();
  const Vector3d center = 0.5 * (low + high), half = 0.5 * (high - low);
  return std::any_of(patches_.begin(), patches_.end(), [&](const Patch& patch) {
    const Vector3d farthest = (center - patch.closest.on_face).cwiseAbs() + half;
    if (farthest.squaredNorm() > patch.radius * patch.radius) return false;
    const double lowest = patch.normal.dot(center) - patch.normal.cwiseAbs().dot(half);
    return patch.keeps_beyond(lowest, nearest);
  });
}

}  // namespace organ_collision
