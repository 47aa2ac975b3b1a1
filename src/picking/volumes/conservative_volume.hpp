#pragma once

#include <Eigen/Core>
#include <variant>

#include "geometry/distance/swept_box.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"
#include "viewing_volume.hpp"

namespace organ_collision {

/// How far a conservative volume grows beyond the space that the tool sweeps.
struct VolumeMargin {
  double motion = 0.0;  ///< [m] largest distance of a face from where it is drawn, at any time
  double extent = 0.0;  ///< [m] largest coordinate of a drawn vertex, relative to the origin
};

/// The space within `radius` [m] of a shaft's axis during one leg.
struct SweptShaft {
  ShaftMotion motion;
  double radius;
};

/// The space that a part of a tool sweeps on one leg, or on the chord of a span of legs.
class PartSweep {
 public:
  /// A shaft with its radius [m].
  PartSweep(const ShaftMotion& shaft, double radius)
      : space_(SweptShaft{shaft, radius}), origin_(shaft.start.trocar), thickness_(radius) {}
  explicit PartSweep(const SweptBox& box);

  /// [m] The origin of the volumes' shifted coordinates, in the organ's frame.
  const Eigen::Vector3d& origin() const { return origin_; }
  /// [m] The radius of the shaft, or half of the middle one of the box's three edge lengths. The
  /// shortest edge of a flat box says nothing about its size.
  double thickness() const { return thickness_; }

  /// A volume that contains every point within margin.motion [m] of the space. This holds for every
  /// motion of a shaft: with a resting or moving trocar, with the tip at the trocar, along the
  /// axis, and without motion (the static query). The volume is grown so that 32-bit clipping loses
  /// no face whose vertices are within margin.extent of the origin. See doc/theory/geometry.md,
  /// Conservative wedge and Margins.
  ViewingVolume volume(const VolumeMargin& margin) const;
  /// The volume without margins. Regions of contacts are clipped to it.
  ViewingVolume tool_volume() const;

 private:
  std::variant<SweptShaft, SweptBox> space_;
  Eigen::Vector3d origin_;
  double thickness_;
};

}  // namespace organ_collision
