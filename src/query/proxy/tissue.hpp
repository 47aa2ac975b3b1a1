#pragma once

#include <cstddef>
#include <vector>

#include "organ_collision/query/collision_query.hpp"
#include "organ_collision/query/haptic_proxy.hpp"

namespace organ_collision {

/// How an organ moves in one tick. The organ does not own its shapes.
struct OrganTick {
  const TriangleMesh* before = nullptr;  ///< null: the organ has no earlier shape to move from
  const TriangleMesh* now = nullptr;
  const SurfaceTopology* topology = nullptr;  ///< of the shape now; null: its sides are unknown
  Eigen::Isometry3d T_before = Eigen::Isometry3d::Identity();  ///< T_organ_proxy
  Eigen::Isometry3d T_now = Eigen::Isometry3d::Identity();

  bool is_moving() const {
    return (before && before != now) || T_before.matrix() != T_now.matrix();
  }
};

/// A contact in the proxy's frame, and whose it is.
struct TissueContact {
  std::size_t organ = 0;
  FaceContact contact;
  /// [m] From the tool, without its growth, to the face at the end of the motion, along the normal.
  /// From the middle line of a part if the growth was negative.
  double distance = 0.0;
};

/// Where an axis crosses an organ's surface, in the proxy's frame, and whose it is.
struct TissueCrossing {
  std::size_t organ = 0;
  AxisCrossing crossing;
};

/// Answers what a tool touches of all organs. The tool may be grown: then it touches whatever comes
/// within that distance of it. A negative growth makes the shaft thinner, and each part of a link
/// becomes the middle line of its box. All poses and contacts are in the proxy's frame.
class Tissue {
 public:
  /// `tool` must outlive this. Throws GlError.
  Tissue(const ProxyTool& tool, const PickerSettings& picker);

  /// The organs at this tick; they must stay as long as this is used.
  void set_organs(const std::vector<OrganTick>& organs) { organs_ = &organs; }

  /// What the tool touches at a pose, against the organs' shapes now. `growth` [m].
  void touch(const ToolPose& pose, double growth, std::vector<TissueContact>& contacts);
  /// What the tool touches on its way along the poses, with the organs at rest in their shapes now.
  void sweep(const std::vector<ToolPose>& way, double growth, std::vector<TissueContact>& contacts);
  /// What the tool touches on its way from one pose to another while the organs move.
  void sweep_with_organs(const ToolPose& from, const ToolPose& to, double growth,
                         std::vector<TissueContact>& contacts);

  /// Whether the shaft or a point of the tool is inside an organ, as far as that is known, or the
  /// shaft's axis crosses a surface.
  bool is_inside(const ToolPose& pose, const Eigen::Vector3d& point);

  /// Where an axis crosses the organs' surfaces, from its trocar to its tip.
  void cross(const ShaftAxis& axis, std::vector<TissueCrossing>& crossings);

  /// [m] The most negative growth. The shaft is then its axis.
  double least_growth() const;

 private:
  void grow(double growth);
  double growth_of(std::uint32_t link) const;
  CollisionRequest request(const OrganTick& organ, QueryMode mode) const;
  void ask(std::size_t organ, const CollisionRequest& question,
           std::vector<TissueContact>& contacts);

  const ProxyTool& tool_;
  double growth_ = 0.0;  ///< [m]
  double radius_ = 0.0;  ///< [m] of the grown shaft; 0: no shaft
  std::vector<Link> grown_links_;
  std::vector<Link> middle_lines_;  ///< of the parts of each link
  const std::vector<OrganTick>* organs_ = nullptr;
  CollisionQuery query_;
  CollisionResult result_;
};

}  // namespace organ_collision
