#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "geometry/distance/first_touch.hpp"
#include "geometry/distance/separating_plane.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "organ_collision/query/contact.hpp"
#include "picking/volumes/conservative_volume.hpp"
#include "step.hpp"

namespace organ_collision {

/// A part of a tool during one leg of a step, or along the chord of a span of legs. Each kind of
/// part is a class, and only PartOnLeg and for_each_part() know which kinds there are.
class MovingPart {
 public:
  virtual ~MovingPart() = default;

  std::int32_t link() const { return link_; }       ///< as in FaceContact
  double radius() const { return radius_; }         ///< [m] the radius around the core or surface
  const CoreMotion& core() const { return core_; }  ///< of a surface, only link() is of use

  /// [m] The radius without which clearances are measured. See ToolClearance.
  virtual double surface_radius() const = 0;
  /// The number of convex parts: a surface has one for each of its triangles.
  virtual std::size_t convex_count() const { return 1; }

  /// The space that the part sweeps, grown by `growth` [m].
  virtual PartSweep sweep(double growth) const = 0;
  /// A box around the space that the core or surface covers, without the radius.
  virtual OrientedBox bounds() const = 0;
  virtual FixedPlane plane(const Eigen::Vector3d& normal) const { return {normal, core_}; }
  /// The normal of a FixedPlane between the closest points of the core and a face. Zero if there is
  /// none, or if the part is a surface.
  virtual Eigen::Vector3d separating_normal(const ClosestPoints& closest) const;

  /// Sets the first touch of each of `faces`: when it first comes within `radius` [m] of the core
  /// or surface. `memory` is for surfaces.
  virtual void find_touches(double radius, WorkBudget& budget, SurfaceTouches& memory,
                            std::vector<FaceTouch>& faces) const;
  /// The closest approach to a face, as the function of the same name.
  virtual std::optional<ClosestApproach> closest_approach(const FaceMotion& face,
                                                          double distance_bound,
                                                          WorkBudget& budget) const;
  /// The closest points of the part, as it is at the start of the leg, and a face. Nothing if they
  /// are farther apart than `bound` [m].
  virtual std::optional<ClosestPoints> closest_at_start(const Triangle& face, double bound) const;
  /// [m] The largest normal . x of the core or surface at the start of the leg. `closest`: its
  /// closest points with something in the direction of `normal`.
  virtual double support_at_start(const Eigen::Vector3d& normal,
                                  const ClosestPoints& closest) const {
    return normal.dot(closest.on_core);
  }

  /// The contact that describes a first touch. The caller sets the number and the vertices of the
  /// face, and the fraction. `face_at_end`: where the face is at the end of the step.
  FaceContact contact(const FirstTouch& touch, const FaceMotion& face,
                      const Triangle& face_at_end) const;
  /// [m] How far the closest point of the core has moved from an earlier pose of the tool to the
  /// end of the step, where it is now.
  virtual Eigen::Vector3d moved_since(const ToolPose& before, const ClosestPoints& now) const = 0;

 protected:
  MovingPart(const ShaftMotion& shaft, double radius)
      : link_(kShaft), radius_(radius), core_(shaft) {}
  MovingPart(std::int32_t link, const LinkPart& part, const RigidMotion& motion)
      : link_(link), radius_(part.radius), core_(part.core, motion) {}

  struct Piercing {
    Eigen::Vector3d normal;  ///< the normal of the contact
    /// [m] How far the tool reaches along the normal at the end of the step: the greatest normal ·
    /// point of the link, or of the ball around the tip.
    double reach_at_end;
  };
  /// `face`: the face at the time `time` of the leg, at which the part pierces it.
  virtual Piercing piercing(double time, const Triangle& face) const = 0;
  /// The point of the core that touched, where it is at the end of the step.
  virtual Eigen::Vector3d at_end(const FirstTouch& touch) const = 0;

 private:
  std::int32_t link_;
  double radius_;
  CoreMotion core_;
};

class MovingShaft : public MovingPart {
 public:
  /// `end`: the axis at the end of the step.
  MovingShaft(const ShaftMotion& motion, double radius, const ShaftAxis& end)
      : MovingPart(motion, radius), motion_(motion), end_(end) {}

  double surface_radius() const override { return radius(); }
  PartSweep sweep(double growth) const override { return {motion_, radius() + growth}; }
  OrientedBox bounds() const override { return box_around(motion_); }
  Eigen::Vector3d moved_since(const ToolPose& before, const ClosestPoints& now) const override {
    return end_.at(now.shaft) - before.axis.at(now.shaft);
  }

 protected:
  Piercing piercing(double time, const Triangle& face) const override;
  Eigen::Vector3d at_end(const FirstTouch& touch) const override {
    return end_.at(touch.closest.shaft);
  }

 private:
  ShaftMotion motion_;
  ShaftAxis end_;
};

/// A convex part of a link.
class MovingLinkPart : public MovingPart {
 public:
  /// `number`: the number of the link. `end`: T_organ_link at the end of the step. `part`, `link`
  /// and `motion` must outlive this object.
  MovingLinkPart(const LinkPart& part, const Link& link, std::int32_t number,
                 const RigidMotion& motion, const Eigen::Isometry3d& end)
      : MovingPart(number, part, motion),
        part_(part),
        its_link_(link),
        motion_(motion),
        end_(end) {}

  double surface_radius() const override { return part_.ball_radius(); }
  PartSweep sweep(double growth) const override {
    return PartSweep(SweptBox(part_.bounds, motion_, radius() + growth));
  }
  OrientedBox bounds() const override { return SweptBox(part_.bounds, motion_, 0.0).bounds(); }
  Eigen::Vector3d moved_since(const ToolPose& before, const ClosestPoints& now) const override;

 protected:
  Piercing piercing(double time, const Triangle& face) const override;
  Eigen::Vector3d at_end(const FirstTouch& touch) const override {
    return end_ * (motion_.at(touch.time).inverse() * touch.closest.on_core);
  }

  const LinkPart& part_;
  const Link& its_link_;
  const RigidMotion& motion_;
  const Eigen::Isometry3d end_;
};

/// A part of a link that is a triangle mesh.
class MovingSurface final : public MovingLinkPart {
 public:
  using MovingLinkPart::MovingLinkPart;

  std::size_t convex_count() const override { return part_.surface->faces().size(); }
  FixedPlane plane(const Eigen::Vector3d& normal) const override {
    return {normal, *part_.surface, motion_};
  }
  Eigen::Vector3d separating_normal(const ClosestPoints& /*closest*/) const override {
    return Eigen::Vector3d::Zero();
  }
  void find_touches(double radius, WorkBudget& budget, SurfaceTouches& memory,
                    std::vector<FaceTouch>& faces) const override;
  std::optional<ClosestApproach> closest_approach(const FaceMotion& face, double distance_bound,
                                                  WorkBudget& budget) const override;
  std::optional<ClosestPoints> closest_at_start(const Triangle& face, double bound) const override;
  double support_at_start(const Eigen::Vector3d& normal,
                          const ClosestPoints& /*closest*/) const override {
    return plane(normal).support();
  }
};

/// Which part of a tool.
struct ToolPart {
  std::int32_t link = kShaft;       ///< the number of its link, or kShaft
  const LinkPart* shape = nullptr;  ///< the part of the link; null for the shaft
};

/// A part of a tool along the chord of a span, as an object of the class of its kind.
class PartOnLeg {
 public:
  /// The step must outlive this object.
  PartOnLeg(const Step& step, const LegSpan& span, const ToolPart& part);
  PartOnLeg(const PartOnLeg&) = delete;
  PartOnLeg& operator=(const PartOnLeg&) = delete;

  const MovingPart& operator*() const { return *part_; }
  const MovingPart* operator->() const { return part_; }

 private:
  std::optional<RigidMotion> motion_;
  std::variant<std::monostate, MovingShaft, MovingLinkPart, MovingSurface> kind_;
  const MovingPart* part_;
};

/// Calls use(part, span) for each part of a tool and each of its spans of legs. The order is: link
/// by link, then span by span, then part by part.
template <typename Use>
void for_each_part(const Step& step, Use use) {
  for (std::size_t leg = 0; step.has_shaft() && leg < step.leg_count();) {
    const LegSpan span = step.shaft_span(leg);
    use(ToolPart{}, span);
    leg = span.end;
  }
  for (std::size_t link = 0; link < step.link_count(); ++link) {
    const LinkBall ball = ball_around(step.link(link));
    for (std::size_t leg = 0; leg < step.leg_count();) {
      const LegSpan span = step.link_span(leg, link, ball);
      for (const LinkPart& part : step.link(link).parts) {
        use(ToolPart{static_cast<std::int32_t>(link), &part}, span);
      }
      leg = span.end;
    }
  }
}

/// The contact of a part and a face that touch on a leg of the step.
FaceContact contact_on(const Step& step, std::size_t leg, const MovingPart& part,
                       std::uint32_t face, const FirstTouch& touch);

}  // namespace organ_collision
