#pragma once

#include <Eigen/Core>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <initializer_list>

#include "organ_collision/geometry/tool/shaft.hpp"
#include "organ_collision/geometry/triangle.hpp"

namespace organ_collision {

/// An integer of any size, for the exact predicates. Only a number of more than 512 bits allocates
/// memory. Numbers become that long only if coordinates span 30 orders of magnitude.
using ExactInteger = boost::multiprecision::number<
    boost::multiprecision::cpp_int_backend<512, 0, boost::multiprecision::signed_magnitude,
                                           boost::multiprecision::unchecked>,
    boost::multiprecision::et_off>;

/// The quotient of two integers, computed to 62 binary digits and then rounded to a double. Equal
/// fractions give equal doubles. The denominator must be positive.
double ratio(const ExactInteger& numerator, const ExactInteger& denominator);

/// The exact vector between two points of an ExactGrid, in units of its spacing.
using IntegerVector = std::array<ExactInteger, 3>;

inline ExactInteger dot(const IntegerVector& a, const IntegerVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline IntegerVector cross(const IntegerVector& a, const IntegerVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A grid on which given points lie exactly. Its spacing is a power of two, so vectors between the
/// points have integer coordinates in units of the spacing.
class ExactGrid {
 public:
  /// The coarsest grid with a spacing of at most 1 m for these points, which must be finite.
  ExactGrid(std::initializer_list<Eigen::Vector3d> points);

  /// The vector from one of the given points to another one.
  IntegerVector difference(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    return {integer(to.x()) - integer(from.x()), integer(to.y()) - integer(from.y()),
            integer(to.z()) - integer(from.z())};
  }

 private:
  ExactInteger integer(double coordinate) const;

  int exponent_ = 0;  ///< the spacing is 2 to the power of exponent_ [m]
};

/// The exact vector from one point to another [m]. It is stored as two points, because their
/// difference would be rounded. Coordinates must be finite and at most a little beyond
/// tolerance::kFarthest. They may be as small as the smallest double.
struct ExactVector {
  Eigen::Vector3d from;
  Eigen::Vector3d to;
};

/// The sign (-1, 0 or 1) of u · (v × w), exactly. Double precision usually suffices. If its
/// rounding errors could change the sign, the sign is computed with integers instead. See
/// doc/theory/geometry.md, Sides and crossings.
int triple_product_sign(const ExactVector& u, const ExactVector& v, const ExactVector& w);

/// The sign of the first component of u × v that is not zero, exactly. 0 if u and v are parallel.
int cross_product_sign(const ExactVector& u, const ExactVector& v);

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
