#pragma once

#include <Eigen/Core>

#include "organ_collision/geometry/tool/shaft.hpp"
#include "organ_collision/geometry/triangle.hpp"

namespace organ_collision {

/// Whether a point is exactly on a face, including its edges and corners. A degenerate face is a
/// segment or a point.
bool is_on_face(const Triangle& face, const Eigen::Vector3d& point);

/// How the axis crosses a face: +1 if it enters, against the face's outward normal, -1 if it
/// leaves, 0 if it does not cross.
///
/// The answer is that for an axis which is moved by the vector (e, e^2, e^3), with an e above zero
/// that is smaller than any number (simulation of simplicity, Edelsbrunner and Mücke 1990). Such an
/// axis meets no edge and no corner, and ends on no face. So neighbouring faces never both miss an
/// axis that passes through their common edge, nor both count it. Over a closed surface, the sum is
/// the winding number about the moved tip minus that about the moved trocar.
int crossing_direction(const Triangle& face, const ShaftAxis& axis);

/// Where the axis crosses a face, without its infinitesimal displacement. The numbers are computed
/// exactly and then rounded, so they do not depend on the order of the face's corners.
struct FaceCrossing {
  /// In the order of the face's corners.
  Eigen::Vector3d barycentric;
  /// The place on the axis, in [0, 1] from trocar to tip.
  double shaft;
  /// What rounding took from `shaft`. Both together are right to 100 binary digits.
  double shaft_rest;
};

/// The crossing of a face whose crossing_direction() is not 0.
FaceCrossing face_crossing(const Triangle& face, const ShaftAxis& axis);

/// [1] The derivative of the crossing's place on the axis by the displacement of the axis, times
/// the largest extent of the axis along a coordinate. If the axis crosses two faces at one place,
/// it meets that one first whose shift is lexicographically smaller.
Eigen::Vector3d crossing_shift(const Triangle& face, const ShaftAxis& axis);

}  // namespace organ_collision
