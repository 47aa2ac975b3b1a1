#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "geometry/distance/first_touch.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "organ_collision/query/contact.hpp"

namespace organ_collision {

/// Where a part of a tool is when the whole step ends: on its shaft, or on a link.
struct PartEnd {
  ShaftAxis axis;                                          ///< of the shaft
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

/// A face on one leg of a step, and where it is when the whole step ends.
struct FaceLeg {
  FaceMotion motion;
  double begin, finish;  ///< the leg's share of the step: fractions in [0, 1]
  Triangle end;
};

/// The contact of a part and a face that first touch as `touch` says. The face's number
/// is left for the caller to set.
FaceContact contact_of(const FirstTouch& touch, const PartLeg& part, const FaceLeg& face);

/// The contact of a candidate face, by exact distances and with as much work as it takes: none if
/// it stays farther from the part's core than the radius during the leg.
std::optional<FaceContact> refine(const PartLeg& part, const FaceLeg& face);

}  // namespace organ_collision
