#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "geometry/distance/first_touch.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "organ_collision/query/contact.hpp"

namespace organ_collision {

/// Where a part of the tool is at the end of the whole step: the place of the shaft, or of the link
/// to which the part belongs.
struct PartEnd {
  ShaftAxis axis;                                          ///< the shaft's axis, if `link` is null
  const Link* link = nullptr;                              ///< the link; null: the shaft
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< T_organ_link of `link`
};

/// A part of a tool on one leg of a step.
struct PartLeg {
  CoreMotion core;
  double radius;  ///< [m] radius around the core
  PartEnd end;
  std::int32_t link = kShaft;
};

/// A face on one leg of a step, and where it is at the end of the whole step.
struct FaceLeg {
  FaceMotion motion;
  double begin, finish;  ///< fractions of the step, in [0, 1], at which the leg begins and ends
  Triangle end;          ///< the face at the end of the step
};

/// The contact that describes the first touch of a part and a face. The caller sets the face's
/// number and vertices.
FaceContact contact_of(const FirstTouch& touch, const PartLeg& part, const FaceLeg& face);

}  // namespace organ_collision
