#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "contact_answer.hpp"
#include "springs.hpp"

namespace organ_collision {

using FaceAndLink = std::pair<std::uint32_t, std::int32_t>;

/// Remembers on which side a tool first touched each face of an organ, with each of its links.
///
/// A contact's normal and depth have no memory: once the axis has passed a face, they push the tool
/// out on the far side. Here the normal keeps pointing into the tissue from the side of first
/// touch, and the depth keeps growing. The side of a face is forgotten at the first answer without
/// this face. A lost answer changes nothing.
///
/// - As long as the axis is on the side of first touch, normal and depth are the contact's. If the
///   axis is closer to the face than half the radius, the normal lags: see greatest_angle().
/// - Past the face, the normal stays. The depth is s - r (n . m), with the shaft's radius s, the
///   kept normal n, the contact's distance r = s - Contact.depth, and its normal m.
/// - A face that the axis pierces has the contact's depth if the tip pierced it and n and m agree.
///   If the axis moved into the face from the side, the depth is s: the distance of the tip beyond
///   the face does not matter.
/// - For links, and for a shaft of unknown radius, half the sum of the depths just before and after
///   passing the face takes the place of s. For a sphere, this is its radius. For a link with flat
///   faces, it is half its thickness.
/// - If a link inside the organ touches a face first from inside, the outer side of the face is
///   kept. The depth is the depth that the link has just below the surface, less the contact's
///   depth.
///
/// A tool that is wholly inside a closed organ touches no face, and is pushed along the nearest way
/// out. "Wholly inside" in doc/forces.md says when, and with which depth.
class PushTracker {
 public:
  /// `pushes_out`: false if tools inside shall not be pushed out, for example in a hollow organ.
  explicit PushTracker(bool pushes_out = true) : pushes_out_(pushes_out) {}

  /// One push for each contact, in the order of the contacts. If the tool is inside and no contact
  /// pushes it, also the push along the nearest way out: its place is the clearance's `on_organ`.
  /// `answer`: the next answer about the same organ and tool, of the same topology.
  ///
  /// Throws Rejection if the tool is inside and nothing pushes it, but the clearance does not tell
  /// the way out: no face is within the margin, the distance is not resolved, or the normal is not
  /// defined.
  std::vector<Push> follow(const ContactArray& answer, const ShaftRadius& shaft_radius);

 private:
  /// The side of first touch of a face.
  struct Side {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< as in Push
    double depth = 0.0;                                ///< [m] as in Push
    double depth_in_plane = 0.0;                       ///< [m] if the axis is in the face's plane
    std::optional<bool> behind = {};  ///< Contact.behind on the kept side; unset: not known yet
    bool by_tip = false;      ///< the tip was nearest when the axis was last on the kept side
    bool is_nearest = false;  ///< a local minimum by basins_of()
    bool is_past = false;     ///< the axis pierces the face, or is on its other side

    static Side first_touch(const Contact& contact, const ShaftRadius& radius);
    static Side first_touch_from_inside(const Contact& contact, double depth_inside);
    void move_on(const Contact& contact);
    void move_on(const Contact& contact, double radius);
  };

  const Side* find(const Contact& contact) const;
  Side side_now(const Contact& contact, const ShaftRadius& shaft_radius, bool began_inside) const;
  std::vector<Push> keep_sides(const ContactArray& answer, const ShaftRadius& shaft_radius,
                               bool began_inside);
  double depth_inside(std::int32_t link, const ShaftRadius& shaft_radius) const;
  void keep_depths(const ContactArray& answer, const std::vector<Push>& pushes);
  Push push_out(const ContactArray& answer, const ShaftRadius& shaft_radius) const;

  bool pushes_out_;
  std::map<FaceAndLink, Side> sides_;
  std::map<std::int32_t, double> depths_;  ///< [m] by link: its depth at its last touch
  std::optional<bool> was_inside_;         ///< the tool, when the last step ended; unset: not known
};

}  // namespace organ_collision
