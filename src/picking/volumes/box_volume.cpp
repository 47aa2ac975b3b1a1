#include "box_volume.hpp"

#include <algorithm>

#include "clipping_rounding.hpp"

namespace organ_collision {
namespace {

/// The box, grown by margin.motion and for rounding.
ViewingVolume box_volume(const SweptBox& box, const VolumeMargin& margin,
                         const Rounding& rounding) {
  const Eigen::Vector3d origin = box.axes().transpose() * box.origin();
  const Eigen::Vector3d low = box.low() - origin, high = box.high() - origin;
  const double reach =
      std::max({margin.extent, low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff()});
  const double grown = margin.motion + rounding.plane * reach;
  return ViewingVolume::orthographic({box.origin(), Eigen::Vector3d::Zero(), box.axes(),
                                      low.x() - grown, high.x() + grown, low.y() - grown,
                                      high.y() + grown, low.z() - grown, high.z() + grown});
}

}  // namespace

ViewingVolume conservative_volume(const SweptBox& box, const VolumeMargin& margin) {
  return box_volume(box, margin, kClippingRounding);
}

ViewingVolume tool_volume(const SweptBox& box) { return box_volume(box, {}, kNoRounding); }

}  // namespace organ_collision
