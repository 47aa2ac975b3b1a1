#pragma once

#include <organ_collision/ContactArray.h>

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace organ_collision {

/// How a point of the tissue pushes the tool. Lengths in metres, vectors in the organ's frame.
struct Push {
  Eigen::Vector3d place;   ///< of the point, at the end of the step
  Eigen::Vector3d normal;  ///< unit, into the tissue; the tool is pushed against it
  double depth;            ///< along the normal; negative if the tool has left the face
  /// Whether it has a spring: it is nearest the tool in its surroundings, or it belongs to another
  /// side of a crease.
  bool counts;
};

/// Remembers on which side a tool first touched each face of an organ, with each of its links.
///
/// A contact's normal and depth have no memory: once the axis has passed a face, they push the tool
/// out on the far side. Here the normal keeps pointing into the tissue from the side of first
/// touch, and the depth keeps growing. The side of a face is forgotten at the first answer without
/// this face, at a static answer (the first one after a reset), and at a new topology. A lost
/// answer changes nothing.
///
/// - As long as the axis is on the side of first touch, normal and depth are the contact's. If the
///   axis is closer to the face than half the radius, the normal lags: see greatest_angle().
/// - Past the face, the normal stays. The depth is s - r (n . m), with the shaft's radius s, the
///   kept normal n, the contact's distance r = s - Contact.depth, and its normal m.
/// - A face that the axis pierces has the contact's depth if the tip pierced it and the two normals
///   agree. If the axis moved into the face from the side, the depth is s: the distance of the tip
///   beyond the face does not matter.
/// - For links, and for a shaft of unknown radius, half the sum of the depths just before and after
///   passing the face takes the place of s. For a sphere, this is its radius. For a link with flat
///   faces, it is half its thickness.
/// - A face that is first touched from inside, by a link that was inside the organ, has the outer
///   side. There the depth is the link's depth just below the surface, less the contact's depth.
class KeptSides {
 public:
  using Radius = std::optional<double>;  ///< [m]
  /// [m] By link: with which depth it is pushed when it is wholly inside, just below the surface.
  /// Twice the radius of a shaft or a sphere.
  using DepthsInside = std::map<std::uint32_t, double>;

  /// One push for each contact, in the order of the contacts. `answer`: the next answer about the
  /// same organ and tool. `shaft_radius`: unset if it is unknown. `inside`: the links that were
  /// inside the organ when the step began.
  std::vector<Push> follow(const ContactArray& answer, const Radius& shaft_radius,
                           const DepthsInside& inside = {});

 private:
  struct Kept {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< as in Push
    double depth = 0.0;                                ///< [m] as in Push
    double depth_in_plane = 0.0;                       ///< [m] with the axis in the face's plane
    std::optional<bool> behind = {};  ///< Contact.behind on the kept side; unset: not known yet
    bool by_tip = false;      ///< the tip was nearest when the axis was last on the kept side
    bool is_nearest = false;  ///< a local minimum by basins_of()
    bool is_past = false;     ///< the axis pierces the face, or is on its other side
  };
  using FaceAndLink = std::pair<std::uint32_t, std::uint32_t>;

  static Kept first_touch(const Contact& contact, const Radius& radius);
  static Kept first_touch_from_inside(const Contact& contact, double depth_inside);
  static void move_on(const Contact& contact, Kept& kept);
  static void move_on(const Contact& contact, double radius, Kept& kept);
  const Kept* find(const Contact& contact) const;
  Kept kept_now(const Contact& contact, const Radius& radius, const DepthsInside& inside) const;

  std::map<FaceAndLink, Kept> kept_;
  std::uint32_t topology_ = 0;
};

/// Pushes a tool that is wholly inside a closed organ along the nearest way out.
///
/// Such a tool touches no face. Its side of the surface is known from ContactArray.placement, the
/// way out from ContactArray.clearance: its normal points to the nearest face. The depth is the
/// distance by which the tool must move along the normal to leave the organ: the clearance's
/// distance plus the depth inside, which is twice the radius for a shaft. For a link it is the
/// depth with which the link was last pushed before it lost touch, or 0 if it was never seen to
/// enter. So the depth continues where the contacts end.
///
/// A tool is taken to be inside if the clearance was asked for, its tip is inside and, for a tool
/// with a shaft, its trocar is inside too and no face is crossed. A tool with links must also touch
/// nothing, because a link may be half inside. The links of a tool are taken to be on the same side
/// as its tip then.
class WayOut {
 public:
  /// `enabled`: false if tools inside shall not be pushed out, for example in a hollow organ.
  explicit WayOut(bool enabled = true) : enabled_(enabled) {}

  /// One push for each contact, in the order of the contacts. If the tool is inside and no contact
  /// pushes it, also the push along the nearest way out: its place is the clearance's `on_organ`.
  /// `answer`, `shaft_radius`: as for KeptSides::follow().
  ///
  /// Throws Rejection if the tool is inside and nothing pushes it, but the clearance does not tell
  /// the way out: no face is within the margin, the distance is not resolved, or the normal is not
  /// defined.
  std::vector<Push> follow(const ContactArray& answer, const KeptSides::Radius& shaft_radius);

 private:
  KeptSides::DepthsInside depths_inside(const ContactArray& answer,
                                        const KeptSides::Radius& shaft_radius) const;
  void keep_depths(const ContactArray& answer, const std::vector<Push>& pushes);
  Push push_out(const ContactArray& answer, const KeptSides::Radius& shaft_radius) const;

  bool enabled_;
  KeptSides sides_;
  KeptSides::DepthsInside depths_;  ///< of the links, when they were last touched
  std::optional<bool> was_inside_;  ///< at the end of the last step; unset: nothing is known of it
  std::uint32_t topology_ = 0;
};

}  // namespace organ_collision
