#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "geometry/distance/swept_box.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"
#include "viewing_volume.hpp"

namespace organ_collision {

/// The space that a part of a tool sweeps: what its conservative volumes are built around, once it
/// is known how far the faces near it move. A view of its motion, which must outlive it.
class PartSweep {
 public:
  /// A shaft of this radius [m].
  PartSweep(const ShaftMotion& shaft, double radius) : shaft_(&shaft), radius_(radius) {}
  explicit PartSweep(const SweptBox& box) : box_(&box) {}

  /// Of the volumes' shifted coordinates [m].
  const Eigen::Vector3d& origin() const { return box_ ? box_->origin() : shaft_->start.trocar; }
  /// [m] The radius of the shaft, or half of the box's middle edge: a box may be flat.
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
