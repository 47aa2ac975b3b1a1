#include "placement_finder.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <tuple>

#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

/// [m] The radius of the volume in which faces near an axis are picked. The faces as drawn are up
/// to tolerance::kSeam away from the welded faces that count. In a volume that is thinner than
/// kShare of the organ, the picker would leave the faces undrawn because of 32-bit clipping.
double picking_radius(const AlignedBox3d& box) {
  constexpr double kShare = 2e-4;
  return 2.0 * tolerance::kSeam + kShare * box.sizes().maxCoeff();
}

/// The shortest ray, along a coordinate axis, from a point in a box to a point outside of the box.
/// If the point is outside already, `length` is negative.
struct ExitRay {
  ExitRay(const Vector3d& point, const AlignedBox3d& box) : end(point) {
    const Vector3d below = point - box.min(), above = box.max() - point;
    Eigen::Index i;
    length = below.cwiseMin(above).minCoeff(&i);
    end[i] = below[i] < above[i] ? box.min()[i] - picking_radius(box)
                                 : box.max()[i] + picking_radius(box);
  }

  Vector3d end;
  double length;  ///< [m] from the point to the side of the box
};

Side side(bool is_on_surface, int winding) {
  if (is_on_surface) return Side::kOnSurface;
  return winding != 0 ? Side::kInside : Side::kOutside;
}

/// [1] The share of the axis that is inside: where the winding number is not zero.
double share_inside(const std::vector<AxisCrossing>& crossings, int trocar_winding) {
  double share = 0.0, place = 0.0;
  int winding = trocar_winding;
  for (const AxisCrossing& crossing : crossings) {
    if (winding != 0) share += crossing.shaft - place;
    place = crossing.shaft;
    winding += crossing.direction;
  }
  return winding != 0 ? share + (1.0 - place) : share;
}

}  // namespace

void PlacementFinder::find(const CollisionRequest& request, AxisPlacement& placement) {
  const SurfaceTopology* topology = request.surface_topology;
  if (topology && !seam_check_.seams_hold(*topology, *request.organ)) topology = nullptr;
  const Surface surface{*request.organ, topology, topology && topology->is_closed()};
  if (request.radius > 0.0) {
    find_axis(surface, request.path.back().axis, placement);
  } else if (request.tip && surface.has_sides) {
    const int winding = winding_number(surface, *request.tip);
    placement.tip = side(is_on_candidate(surface, *request.tip), winding);
  }
}

/// The crossings tell how the winding number changes along the axis. So the winding number is
/// needed at one end only. It is zero if that end is outside of the organ's box.
void PlacementFinder::find_axis(const Surface& surface, const ShaftAxis& axis,
                                AxisPlacement& placement) {
  pick_near(axis, surface.organ);
  find_crossings(surface, axis, placement.crossings);
  if (!surface.has_sides) return;
  const bool is_trocar_on = is_on_candidate(surface, axis.trocar);
  const bool is_tip_on = is_on_candidate(surface, axis.tip);
  int change = 0;
  for (const AxisCrossing& crossing : placement.crossings) change += crossing.direction;
  const AlignedBox3d box = surface.organ.box().cast<double>();
  const bool from_trocar = ExitRay(axis.trocar, box).length <= ExitRay(axis.tip, box).length;
  const int trocar_winding = from_trocar ? winding_number(surface, axis.trocar)
                                         : winding_number(surface, axis.tip) - change;
  placement.trocar = side(is_trocar_on, trocar_winding);
  placement.tip = side(is_tip_on, trocar_winding + change);
  placement.length_known = true;
  placement.length_inside =
      share_inside(placement.crossings, trocar_winding) * axis.along().stableNorm();
}

/// Replaces candidates_ by the faces that may meet `axis`.
void PlacementFinder::pick_near(const ShaftAxis& axis, const TriangleMesh& organ) {
  const double radius = picking_radius(organ.box().cast<double>());
  picker_.pick(PartSweep({axis, axis}, radius), OrganMotion(organ), candidates_);
}

/// Finds the crossings, in the order in which the axis meets them after its infinitesimal
/// displacement (see crossing_direction()).
void PlacementFinder::find_crossings(const Surface& surface, const ShaftAxis& axis,
                                     std::vector<AxisCrossing>& crossings) {
  found_.clear();
  for (const Candidate& candidate : candidates_) {
    const Triangle face = surface.face(candidate.face);
    const int direction = crossing_direction(face, axis);
    if (direction == 0) continue;
    found_.push_back({candidate.face, direction, face_crossing(face, axis)});
  }
  std::sort(found_.begin(), found_.end(), [&](const FoundCrossing& a, const FoundCrossing& b) {
    if (a.place.shaft != b.place.shaft) return a.place.shaft < b.place.shaft;
    if (a.place.shaft_rest != b.place.shaft_rest) return a.place.shaft_rest < b.place.shaft_rest;
    const Vector3d shift_a = crossing_shift(surface.face(a.face), axis);
    const Vector3d shift_b = crossing_shift(surface.face(b.face), axis);
    return std::tie(shift_a.x(), shift_a.y(), shift_a.z(), a.direction, a.face) <
           std::tie(shift_b.x(), shift_b.y(), shift_b.z(), b.direction, b.face);
  });
  for (const FoundCrossing& found : found_) {
    const Vector3d& barycentric = found.place.barycentric;
    crossings.push_back({found.face, surface.organ.faces()[found.face], barycentric,
                         found.place.shaft, point_at(surface.face(found.face), barycentric),
                         static_cast<std::int8_t>(found.direction)});
  }
}

/// The winding number of a closed surface about a point, after the infinitesimal displacement. It
/// is zero outside of the organ's box. For a point in the box, the crossings of a ray to the
/// outside give it. Replaces candidates_ by the faces near that ray.
int PlacementFinder::winding_number(const Surface& surface, const Vector3d& point) {
  const AlignedBox3d box = surface.organ.box().cast<double>();
  candidates_.clear();
  if (!box.contains(point)) return 0;
  const ShaftAxis ray{point, ExitRay(point, box).end};
  pick_near(ray, surface.organ);
  int change = 0;
  for (const Candidate& candidate : candidates_) {
    change += crossing_direction(surface.face(candidate.face), ray);
  }
  return -change;
}

/// Whether the point is exactly on one of the faces in candidates_.
bool PlacementFinder::is_on_candidate(const Surface& surface, const Vector3d& point) const {
  return std::any_of(candidates_.begin(), candidates_.end(), [&](const Candidate& candidate) {
    return is_on_face(surface.face(candidate.face), point);
  });
}

}  // namespace organ_collision
