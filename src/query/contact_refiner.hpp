#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "geometry/distance/first_touch.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "organ_collision/query/contact.hpp"

namespace organ_collision {

/// Where the shaft, or the link that has the part, is at the end of the whole step.
struct PartEnd {
  ShaftAxis axis;                                          ///< of the shaft, if `link` is null
  const Link* link = nullptr;                              ///< null: the part is the shaft
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< T_organ_link
};

/// A convex part of a tool on one leg of a step.
struct PartLeg {
  CoreMotion core;
  double radius;  ///< [m]
  PartEnd end;
  std::uint32_t link = 0;  ///< number of its link, as in FaceContact
};

/// A face on one leg of a step, and where it is at the end of the whole step.
struct FaceLeg {
  FaceMotion motion;
  double begin, finish;  ///< fractions of the step, in [0, 1], at which the leg begins and ends
  Triangle end;          ///< at the end of the step
};

/// The contact that follows from the first touch of a part and a face. The caller sets the face's
/// number and vertices.
FaceContact contact_of(const FirstTouch& touch, const PartLeg& part, const FaceLeg& face);

}  // namespace organ_collision
