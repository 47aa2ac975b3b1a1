#include "patch_finder.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

// [1] How much nearer than the plane a covered face may be: a share of the clearance, which a proxy
// keeps to 1 %, and a share of the distance beyond the clearance.
constexpr double kRoughness = 0.005, kRoughnessBeyond = 0.05;
/// To look how far a face comes costs a share of a test.
constexpr std::size_t kLooksPerTest = 4;

/// Whether all corners of a face are within a distance [m] of a point.
bool is_within(double distance, const Vector3d& point, const Triangle& face) {
  return std::all_of(face.begin(), face.end(), [&](const Vector3d& corner) {
    return (corner - point).squaredNorm() <= distance * distance;
  });
}

/// [m] Beyond this value along a direction are all corners of a face that have come against it.
double lowest(const Vector3d& direction, const Triangle& face, const Vector3d& come) {
  return std::min({direction.dot(face[0]) - come[0], direction.dot(face[1]) - come[1],
                   direction.dot(face[2]) - come[2]});
}

}  // namespace

bool PatchFinder::find(const Step& step, const std::vector<Limits>& of_parts, const Coming& late,
                       const Coming& soon, std::size_t& tests, std::vector<Found>& contacts) {
  bool is_complete = true;
  std::size_t looks = 0;
  Coming counted{{}, soon.most};
  if (soon.against) {
    counted.against = [&](std::uint32_t face, const Triangle& corners, const Vector3d& normal) {
      ++looks;
      return soon.against(face, corners, normal);
    };
  }
  for_each_part(step, [&](const ToolPart& part, const LegSpan& span) {
    const Limits& limits = of_parts[part_index(part.link)];
    if (limits.distance == 0.0) return;
    const PartOnLeg moving(step, span, part);
    const OrganMotion organ = step.organ_motion(span);
    const double bound = limits.distance + moving->radius();
    Nearest nearest{bound, bound};
    patches_.clear();
    last_ = 0;
    const std::size_t left = search_.visit(
        organ, moving->bounds(), [&] { return bound; },
        [&](const BlockBoxes::Box& box) { return is_covered(box, soon.most, nearest); },
        [&](std::uint32_t face) {
          tests -= std::min(tests, looks / kLooksPerTest);
          looks %= kLooksPerTest;
          if (tests == 0) return false;
          const Triangle corners = organ.after().triangle(face);
          if (is_covered(face, corners, counted, nearest)) return true;
          --tests;
          const auto closest = moving->closest_at_start(corners, bound);
          if (!closest || closest->distance > bound) return true;
          Patch& patch = patches_.emplace_back(face, *closest, *moving, limits);
          patch.ahead = distance_ahead(patch, *moving, limits, corners, counted);
          // The share of the distance beyond the clearance is that of the distance ahead.
          patch.roughness =
              std::max(kRoughness * limits.clearance,
                       patch.roughness - kRoughnessBeyond * (closest->distance - patch.ahead));
          nearest.now = std::min(nearest.now, closest->distance);
          nearest.ahead = std::min(nearest.ahead, patch.ahead);
          return true;
        });
    if (left > 0) is_complete = false;
    std::sort(patches_.begin(), patches_.end(), [](const Patch& a, const Patch& b) {
      return std::tie(a.ahead, a.face) < std::tie(b.ahead, b.face);
    });
    found_.swap(patches_);
    patches_.clear();
    for (const Patch& patch : found_) {
      if (patches_.size() == kMost) break;
      const Triangle face = organ.after().triangle(patch.face);
      const bool is_covered = std::any_of(patches_.begin(), patches_.end(), [&](const Patch& of) {
        return (of.closest.on_face - patch.closest.on_face).norm() <= of.radius &&
               of.keeps_off(patch.face, face, soon, nearest);
      });
      if (is_covered) continue;
      patches_.push_back(patch);
      contacts.push_back(
          {contact_on(step, span.begin, *moving, patch.face, {0.0, patch.closest}),
           patch.closest.distance - moving->radius(),
           patch.closest.distance - distance_ahead(patch, *moving, limits, face, late)});
    }
  });
  return is_complete;
}

/// [m] How far the core of a part is from a face after its tissue has come, or less. Each plane
/// between them is a lower bound of their distance. The first one is at right angles to the contact
/// normal. Where the face turns as it comes, one beside it is better.
double PatchFinder::distance_ahead(const Patch& patch, const MovingPart& part, const Limits& limits,
                                   const Triangle& corners, const Coming& coming) {
  const double now = patch.closest.distance;
  if (!coming.against || now <= tolerance::kPierced) return now;
  const Vector3d come = coming.against(patch.face, corners, patch.normal);
  if (come.maxCoeff() == 0.0) return now;
  double ahead = lowest(patch.normal, corners, come) - patch.support;
  if (come.maxCoeff() - come.minCoeff() > kRoughness * limits.clearance) {
    Triangle moved = corners;
    for (int k = 0; k < 3; ++k) moved[k] -= come[k] * patch.normal;
    const auto closest = part.closest_at_start(moved, now);
    if (closest && closest->distance > tolerance::kPierced && closest->distance < now) {
      const Patch turned(patch.face, *closest, part, limits);
      const Vector3d come_then = coming.against(patch.face, corners, turned.normal);
      ahead = std::max(ahead, lowest(turned.normal, corners, come_then) - turned.support);
    }
  }
  return std::min(ahead, now);
}

PatchFinder::Patch::Patch(std::uint32_t its_face, const ClosestPoints& its_closest,
                          const MovingPart& part, const Limits& limits)
    : face(its_face), closest(its_closest), ahead(closest.distance) {
  const double distance = closest.distance - part.radius();
  radius = std::max(limits.patch, distance);
  roughness =
      kRoughness * limits.clearance + kRoughnessBeyond * std::max(0.0, distance - limits.clearance);
  if (closest.distance <= tolerance::kPierced) return;
  normal = closest.separation.normalized();
  support = part.support_at_start(normal, closest);
}

bool PatchFinder::Patch::keeps_beyond(double lowest, double distance, double nearest) const {
  const double least = std::min(std::max(distance - roughness, nearest), distance);
  return lowest - support > least - tolerance::kPierced;
}

bool PatchFinder::Patch::keeps_off(std::uint32_t number, const Triangle& corners,
                                   const Coming& coming, const Nearest& nearest) const {
  const double low = project_onto(normal, corners).low;
  if (!keeps_beyond(low, closest.distance, nearest.now)) return false;
  if (!coming.against || keeps_beyond(low - coming.most, ahead, nearest.ahead)) return true;
  return keeps_beyond(lowest(normal, corners, coming.against(number, corners, normal)), ahead,
                      nearest.ahead);
}

/// Whether a face that was found covers this one. A covered face is not nearer than `nearest`.
bool PatchFinder::is_covered(std::uint32_t number, const Triangle& face, const Coming& coming,
                             const Nearest& nearest) {
  const auto covers = [&](const Patch& patch) {
    return is_within(patch.radius, patch.closest.on_face, face) &&
           patch.keeps_off(number, face, coming, nearest);
  };
  if (last_ < patches_.size() && covers(patches_[last_])) return true;
  const auto found = std::find_if(patches_.begin(), patches_.end(), covers);
  if (found == patches_.end()) return false;
  last_ = static_cast<std::size_t>(found - patches_.begin());
  return true;
}

/// The same for all faces in a box, which come by at most `most` [m].
bool PatchFinder::is_covered(const BlockBoxes::Box& box, double most,
                             const Nearest& nearest) const {
  const Vector3d low = box.min.head<3>().matrix().cast<double>();
  const Vector3d high = box.max.head<3>().matrix().cast<double>();
  const Vector3d center = 0.5 * (low + high), half = 0.5 * (high - low);
  return std::any_of(patches_.begin(), patches_.end(), [&](const Patch& patch) {
    const Vector3d farthest = (center - patch.closest.on_face).cwiseAbs() + half;
    if (farthest.squaredNorm() > patch.radius * patch.radius) return false;
    const double lowest = patch.normal.dot(center) - patch.normal.cwiseAbs().dot(half);
    return patch.keeps_beyond(lowest, patch.closest.distance, nearest.now) &&
           (most == 0.0 || patch.keeps_beyond(lowest - most, patch.ahead, nearest.ahead));
  });
}

}  // namespace organ_collision
