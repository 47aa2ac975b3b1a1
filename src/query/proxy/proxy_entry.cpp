#include "proxy_entry.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

bool is_clear(const ToolPose& pose, double clearance, Tissue& tissue) {
  std::vector<TissueContact> contacts;
  tissue.touch(pose, clearance, contacts);
  return contacts.empty();
}

/// The box around all organs in the proxy's frame [m].
Eigen::AlignedBox3d box_around(const std::vector<OrganTick>& organs) {
  Eigen::AlignedBox3d box;
  for (const OrganTick& organ : organs) {
    const Eigen::AlignedBox3d own = organ.now->box().cast<double>();
    for (int corner = 0; corner < 8; ++corner) {
      const auto type = static_cast<Eigen::AlignedBox3d::CornerType>(corner);
      box.extend(organ.T_now.inverse() * own.corner(type));
    }
  }
  return box;
}

/// The hand's tool, moved straight away from the middle of all organs until it is beyond them.
ToolPose beyond(const std::vector<OrganTick>& organs, const Mobility& mobility,
                const ToolPose& hand) {
  const Eigen::AlignedBox3d box = box_around(organs);
  Vector3d away = mobility.center(hand) - box.center();
  away = away.norm() > 0.0 ? Vector3d(away.normalized()) : Vector3d(Vector3d::UnitZ());
  const double distance = 0.5 * box.diagonal().norm() + 2.0 * mobility.size();
  Displacement displacement = Displacement::Zero();
  displacement.head<3>() = box.center() + distance * away - mobility.center(hand);
  return mobility.moved(hand, displacement, hand);
}

}  // namespace

ProxyEntry enter(const ProxyTool& tool, const Mobility& mobility, const ToolPose& hand,
                 double clearance, const std::vector<OrganTick>& organs, Tissue& tissue) {
  ToolPose pose = hand;
  if (tool.freedom == ProxyFreedom::kTrocar) {
    pose.axis.tip = hand.axis.trocar;
    pose = mobility.combine(pose, hand);
    if (!is_clear(pose, clearance, tissue)) {
      return {{}, "the trocar is in tissue: the proxy cannot be placed from outside"};
    }
  } else if (!is_clear(pose, clearance, tissue) || tissue.is_inside(pose, mobility.center(pose))) {
    pose = beyond(organs, mobility, hand);
    if (!is_clear(pose, clearance, tissue)) {
      return {{}, "there is no room beyond the organs: the proxy cannot be placed from outside"};
    }
  }
  return {ProxyPlace{pose, clearance}, {}};
}

}  // namespace organ_collision
