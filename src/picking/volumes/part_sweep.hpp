#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "box_volume.hpp"
#include "conservative_volume.hpp"

namespace organ_collision {

/// The space that a part of a tool sweeps on one leg, or on the chord of a span of legs. It builds
/// the conservative volumes around that space once the margins are known. It refers to the motion
/// or the box, which must outlive it.
class PartSweep {
 public:
  /// A shaft with its radius [m].
  PartSweep(const ShaftMotion& shaft, double radius) : shaft_(&shaft), radius_(radius) {}
  explicit PartSweep(const SweptBox& box) : box_(&box) {}

  /// [m] The origin of the volumes' shifted coordinates, in the organ's frame.
  const Eigen::Vector3d& origin() const { return box_ ? box_->origin() : shaft_->start.trocar; }
  /// [m] The radius of the shaft, or half of the middle one of the box's three edge lengths: the
  /// shortest edge of a flat box says nothing about its size.
  double thickness() const {
    if (!box_) return radius_;
    Eigen::Vector3d edges = box_->high() - box_->low();
    std::sort(edges.data(), edges.data() + edges.size());
    return 0.5 * edges[1];
  }
  ViewingVolume volume(const VolumeMargin& margin) const {
    return box_ ? conservative_volume(*box_, margin)
                : conservative_volume(*shaft_, radius_, margin);
  }

 private:
  const SweptBox* box_ = nullptr;
  const ShaftMotion* shaft_ = nullptr;
  double radius_ = 0.0;
};

}  // namespace organ_collision
