#pragma once

#include <Eigen/Core>

#include "organ_collision/geometry/tool/shaft.hpp"
#include "organ_collision/geometry/triangle.hpp"

namespace organ_collision {

/// Whether a point is exactly on a face, including its edges and corners. A degenerate face is a
/// segment or a point.
bool is_on_face(const Triangle& face, const Eigen::Vector3d& point);

/// How the axis crosses a face: +1 if it enters the organ, against the face's outward normal, -1 if
/// it leaves the organ, 0 if it does not cross the face.
///
/// The answer is given for an axis that is moved by the vector (e, e^2, e^3). Here e is positive
/// and smaller than any number (simulation of simplicity, Edelsbrunner and Mücke 1990). The moved
/// axis meets no edge and no corner, and ends on no face. So an axis through the common edge of two
/// faces crosses one of them if it passes through the surface there, and both or none if it only
/// grazes the edge. The sum over a closed surface is the winding number about the moved tip minus
/// the winding number about the moved trocar.
int crossing_direction(const Triangle& face, const ShaftAxis& axis);

/// Where the axis crosses a face, without the infinitesimal displacement. The numbers are computed
/// exactly and then rounded, so they do not depend on the order of the face's corners.
struct FaceCrossing {
  /// The barycentric coordinates of the crossing, in the order of the face's corners.
  Eigen::Vector3d barycentric;
  /// The place of the crossing on the axis, in [0, 1] from trocar to tip.
  double shaft;
  /// The exact place minus `shaft`. The sum of both numbers is right to 100 binary digits.
  double shaft_rest;
};

/// The crossing of a face whose crossing_direction() is not 0.
FaceCrossing face_crossing(const Triangle& face, const ShaftAxis& axis);

/// [1] How the place of a crossing on the axis changes with the displacement of the axis: the
/// derivative times the largest extent of the axis along a coordinate. If the axis crosses two
/// faces at one place, the moved axis first meets the face whose shift is lexicographically
/// smaller.
Eigen::Vector3d crossing_shift(const Triangle& face, const ShaftAxis& axis);

}  // namespace organ_collision
