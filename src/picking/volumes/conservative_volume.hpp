#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "geometry/distance/swept_box.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"
#include "viewing_volume.hpp"

namespace organ_collision {

/// How far a conservative volume grows beyond the space that the tool sweeps.
struct VolumeMargin {
  double motion = 0.0;  ///< [m] largest distance of a face from where it is drawn, at any time
  double extent = 0.0;  ///< [m] largest coordinate of a drawn vertex, relative to the origin
};

/// A volume that contains every point within `radius` + margin.motion [m] of the axis at some time
/// of the leg. This holds for every motion: with a resting or moving trocar, with the tip at the
/// trocar, along the axis, and without motion (the static query). The volume is grown so that
/// 32-bit clipping loses no face whose vertices are within `margin.extent` of the trocar. See
/// doc/theory/geometry.md, Conservative wedge and Margins.
ViewingVolume conservative_volume(const ShaftMotion& motion, double radius,
                                  const VolumeMargin& margin);

/// The conservative volume of a shaft without margins. Regions of contacts are clipped to it.
ViewingVolume tool_volume(const ShaftMotion& motion, double radius);

/// An orthographic box that contains the swept box, grown by margin.motion, at every time of the
/// leg. It is also grown for 32-bit clipping, like the conservative volume of a shaft.
ViewingVolume conservative_volume(const SweptBox& box, const VolumeMargin& margin);

/// The volume of a swept box without margins. Regions of contacts are clipped to it.
ViewingVolume tool_volume(const SweptBox& box);

/// The space that a part of a tool sweeps on one leg, or on the chord of a span of legs. volume()
/// gives a conservative volume around it as soon as the margin is known.
class PartSweep {
 public:
  /// A shaft with its radius [m].
  PartSweep(const ShaftMotion& shaft, double radius) : shaft_(shaft), radius_(radius) {}
  explicit PartSweep(const SweptBox& box) : box_(box) {}

  /// [m] The origin of the volumes' shifted coordinates, in the organ's frame.
  const Eigen::Vector3d& origin() const { return box_ ? box_->origin() : shaft_.start.trocar; }
  /// [m] The radius of the shaft, or half of the middle one of the box's three edge lengths. The
  /// shortest edge of a flat box says nothing about its size.
  double thickness() const {
    if (!box_) return radius_;
    Eigen::Vector3d edges = box_->high() - box_->low();
    std::sort(edges.data(), edges.data() + edges.size());
    return 0.5 * edges[1];
  }
  ViewingVolume volume(const VolumeMargin& margin) const {
    return box_ ? conservative_volume(*box_, margin) : conservative_volume(shaft_, radius_, margin);
  }

 private:
  std::optional<SweptBox> box_;
  ShaftMotion shaft_;
  double radius_ = 0.0;
};

}  // namespace organ_collision
