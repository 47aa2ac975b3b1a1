#pragma once

#include <organ_collision/ContactArray.h>

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace organ_collision {

/// What one contact pushes with. Lengths in metres, vectors in the organ's frame.
struct Push {
  Eigen::Vector3d place;   ///< Contact.end_point
  Eigen::Vector3d normal;  ///< unit, from the side on which the tool first touched into the tissue
  double depth;            ///< along the normal; what was left is negative
  bool counts;             ///< it is nearest the tool in its surroundings, or is a side of its own
};

/// Remembers on which side a tool first touched each face of an organ, with each of its links.
///
/// A contact's normal and depth have no memory: once the axis has passed a face, they say that the
/// tool is to be pushed out on the far side. Here the normal stays that of the side of first touch,
/// and the depth grows on. What is known of a face is forgotten with the first answer that does not
/// have the face, with a static answer (the first one after a reset), and with a new topology. An
/// answer that got lost changes nothing.
///
/// - On that side the normal is the contact's, and so is the depth. Where the axis is nearer than
///   half the radius, the normal lags: see greatest_angle().
/// - Past the face the normal stays. The depth is s - r (n . m), with the shaft's radius s, the
///   kept normal n, the contact's distance r = s - Contact.depth, and its normal m.
/// - A face that the axis pierces is as deep as the contact says if the tip came first and the
///   normals agree. A face that the axis came to lie in from the side is s deep: how far the tip is
///   beyond it does not matter.
/// - Of links, and of a shaft of unknown radius, the depth stays as it was, while they are past.
class KeptSides {
 public:
  using Radius = std::optional<double>;  ///< [m]

  /// One push for each contact, in their order. `answer` follows on that of the last call, of the
  /// same organ and tool; `shaft_radius`: of the tool's shaft, where it is known.
  std::vector<Push> follow(const ContactArray& answer, const Radius& shaft_radius);

 private:
  struct Kept {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< as in Push
    double depth = 0.0;                                ///< [m] as in Push
    double depth_in_plane = 0.0;                       ///< [m] with the axis in the face's plane
    std::optional<bool> behind = {};  ///< Contact.behind on that side; none: the axis only pierced
    bool by_tip = false;              ///< the tip was nearest when the axis was last on that side
    bool is_nearest = false;          ///< as basins_of() says
    bool is_past = false;             ///< the axis pierces the face, or is on its other side
  };
  using FaceAndLink = std::pair<std::uint32_t, std::uint32_t>;

  static Kept first_touch(const Contact& contact, const Radius& radius);
  static void move_on(const Contact& contact, Kept& kept);
  static void move_on(const Contact& contact, double radius, Kept& kept);
  const Kept* find(const Contact& contact) const;
  Kept kept_now(const Contact& contact, const Radius& radius) const;

  std::map<FaceAndLink, Kept> kept_;
  std::uint32_t topology_ = 0;
};

}  // namespace organ_collision
