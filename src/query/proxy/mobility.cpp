#include "mobility.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/tool/leg_motion.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Translation3d;
using Eigen::Vector3d;

/// [m] An axis shorter than this counts as a point without a direction.
constexpr double kShortestAxis = 1e-9;

bool has_direction(const ShaftAxis& axis) { return axis.along().norm() > kShortestAxis; }

/// The smallest rotation that turns one axis into the direction of another.
Quaterniond turn(const ShaftAxis& from, const ShaftAxis& to) {
  if (!has_direction(from) || !has_direction(to)) return Quaterniond::Identity();
  return least_rotation(from.along(), to.along());
}

/// The pose after a rigid motion of the whole tool.
ToolPose operator*(const Isometry3d& motion, const ToolPose& pose) {
  ToolPose result{{motion * pose.axis.trocar, motion * pose.axis.tip}, {}, {}};
  for (const Isometry3d& link : pose.links) {
    Isometry3d moved(Quaterniond((motion * link).linear()).normalized());
    moved.translation() = motion * link.translation();
    result.links.push_back(moved);
  }
  if (pose.tip) result.tip = motion * *pose.tip;
  return result;
}

/// [m] No point of a link at `pose` is farther from `center` than this.
double farthest(const Link& link, const Isometry3d& pose, const Vector3d& center) {
  double most = 0.0;
  for (const LinkPart& part : link.parts) {
    const double to_middle = (pose * part.bounds.center - center).norm();
    most = std::max(most, to_middle + part.bounds.half_size.norm() + part.radius);
  }
  return most;
}

/// A tool through a trocar. Its coordinates are the displacement of its tip, and three zeros.
class TrocarMobility : public Mobility {
 public:
  explicit TrocarMobility(const ProxyTool& tool) : tool_(tool) {}

  Displacement between(const ToolPose& from, const ToolPose& to) const override {
    Displacement result = Displacement::Zero();
    result.head<3>() = to.axis.tip - from.axis.tip;
    return result;
  }
  ToolPose moved(const ToolPose& pose, const Displacement& displacement,
                 const ToolPose& hand) const override {
    return at(pose.axis.tip + displacement.head<3>(), hand);
  }
  Displacement row(const ToolPose& pose, const FaceContact& contact) const override {
    Displacement result = Displacement::Zero();
    if (contact.link == kShaft) {
      result.head<3>() = contact.shaft * contact.normal;
    } else {
      // The rotation vector of shaft and links is (axis x displacement) / length^2.
      result.head<3>() = contact.normal;
      if (has_direction(pose.axis)) {
        const Vector3d arm = contact.point - pose.axis.tip;
        result.head<3>() +=
            arm.cross(contact.normal).cross(pose.axis.along()) / pose.axis.along().squaredNorm();
      }
    }
    return result;
  }
  double longest_way(const ToolPose& pose, const Displacement& displacement) const override {
    double arm = 0.0;
    for (std::size_t link = 0; link < pose.links.size(); ++link) {
      arm = std::max(arm, farthest(tool_.links[link], pose.links[link], pose.axis.tip));
    }
    const double length = pose.axis.along().norm();
    return displacement.norm() * (length > kShortestAxis ? 1.0 + arm / length : 1.0);
  }
  Vector3d center(const ToolPose& pose) const override { return pose.axis.tip; }

 private:
  /// The hand's pose, turned about its trocar and moved along its axis until its tip is at `tip`.
  static ToolPose at(const Vector3d& tip, const ToolPose& hand) {
    const ShaftAxis axis{hand.axis.trocar, tip};
    if (tip == hand.axis.tip) return hand;
    ToolPose result = Translation3d(tip) * Isometry3d(turn(hand.axis, axis)) *
                      Translation3d(-hand.axis.tip) * hand;
    result.axis = axis;
    return result;
  }

  const ProxyTool& tool_;
};

/// A free tool. The coordinates are the translation of its centre, and the rotation vector times
/// its size.
class FreeMobility : public Mobility {
 public:
  explicit FreeMobility(const ProxyTool& tool) : tool_(tool) {}

  /// The centre of a shaft alone is its middle. The centre of a tool with links is the mean of the
  /// middles of the links' parts. The size is the radius of gyration of a rod that reaches as far
  /// from the centre as the tool.
  void measure(const ToolPose& hand) override {
    if (tool_.links.empty()) {
      extent_ = 0.5 * hand.axis.along().norm() + tool_.radius;
    } else {
      Vector3d sum = Vector3d::Zero();
      std::size_t count = 0;
      for (std::size_t link = 0; link < hand.links.size(); ++link) {
        for (const LinkPart& part : tool_.links[link].parts) {
          sum += hand.links[link] * part.bounds.center;
          ++count;
        }
      }
      const Vector3d middle = count > 0 ? Vector3d(sum / static_cast<double>(count))
                                        : Vector3d(hand.links[0].translation());
      center_in_base_ = hand.links[0].inverse() * middle;
      extent_ = tool_.radius > 0.0 ? std::max((hand.axis.tip - middle).norm(),
                                              (hand.axis.trocar - middle).norm()) +
                                         tool_.radius
                                   : 0.0;
      for (std::size_t link = 0; link < hand.links.size(); ++link) {
        extent_ = std::max(extent_, farthest(tool_.links[link], hand.links[link], middle));
      }
    }
    size_ = extent_ / std::sqrt(3.0);
  }

  Displacement between(const ToolPose& from, const ToolPose& to) const override {
    const Eigen::AngleAxisd turned(rotation(from, to));
    Displacement result;
    // The remainder is the shorter of the two ways round.
    const double angle = std::remainder(turned.angle(), 2.0 * M_PI);
    result << center(to) - center(from), size_ * angle * turned.axis();
    return result;
  }
  ToolPose moved(const ToolPose& pose, const Displacement& displacement,
                 const ToolPose& hand) const override {
    const Vector3d turned = displacement.tail<3>() / size_;
    const double angle = turned.norm();
    const Quaterniond further = angle > 0.0 ? Quaterniond(Eigen::AngleAxisd(angle, turned / angle))
                                            : Quaterniond::Identity();
    return at(center(pose) + displacement.head<3>(), further * rotation(hand, pose), hand);
  }
  Displacement row(const ToolPose& pose, const FaceContact& contact) const override {
    Displacement result;
    result << contact.normal, (contact.point - center(pose)).cross(contact.normal) / size_;
    return result;
  }
  double longest_way(const ToolPose&, const Displacement& displacement) const override {
    return displacement.head<3>().norm() + displacement.tail<3>().norm() * extent_ / size_;
  }
  Vector3d center(const ToolPose& pose) const override {
    if (tool_.links.empty()) return pose.axis.at(0.5);
    return pose.links[0] * center_in_base_;
  }
  double size() const override { return size_; }

 private:
  /// The rotation of the tool's base from one pose to another. The base is the first link or, for a
  /// shaft alone, the axis.
  Quaterniond rotation(const ToolPose& from, const ToolPose& to) const {
    if (tool_.links.empty()) return turn(from.axis, to.axis);
    return Quaterniond(to.links[0].linear() * from.links[0].linear().transpose()).normalized();
  }
  /// The hand's pose, rotated by `turned` about its centre, which is then moved to `where`.
  ToolPose at(const Vector3d& where, const Quaterniond& turned, const ToolPose& hand) const {
    return Translation3d(where) * Isometry3d(turned) * Translation3d(-center(hand)) * hand;
  }

  const ProxyTool& tool_;
  Vector3d center_in_base_ = Vector3d::Zero();
  double extent_ = 1.0;  ///< [m] farthest distance of a point of the tool from the centre
  double size_ = 1.0;
};

}  // namespace

std::unique_ptr<Mobility> make_mobility(const ProxyTool& tool) {
  if (tool.freedom == ProxyFreedom::kTrocar) return std::make_unique<TrocarMobility>(tool);
  return std::make_unique<FreeMobility>(tool);
}

}  // namespace organ_collision
