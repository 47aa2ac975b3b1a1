#include "plausible_size.hpp"

#include <iomanip>

#include "concatenate.hpp"

namespace organ_collision {
namespace {

/// [m] Plausible lengths of the longest side of the box around an organ: from a small vessel to a
/// whole body.
constexpr double kLargestOrgan = 3.0;
constexpr double kSmallestOrgan = 1e-3;
/// [m] Plausible radii of a shaft: from that of a hair to one much above that of any instrument.
constexpr double kLargestRadius = 0.1;
constexpr double kSmallestRadius = 2e-5;
/// [m] Plausible sizes of a link: from a needle's point to the arm of a large robot.
constexpr double kLargestLink = 3.0;
constexpr double kSmallestLink = 2e-4;
/// [m] The largest plausible distance of a tool from an organ: through an operating room.
constexpr double kLargestDistance = 10.0;

/// The sentence "WHAT; plausible are ..." about a length [m]. Empty if the length is plausible.
std::string doubt_about(const std::string& what, double length, double smallest, double largest) {
  if (length >= smallest && length <= largest) return {};
  return concatenate(
      what, "; plausible are ", smallest, " to ", largest, " m. Lengths are in metres: ",
      length > largest ? "are these millimetres?" : "were they converted from millimetres twice?");
}

}  // namespace

std::string sides_of(const Eigen::AlignedBox3d& box) {
  const Eigen::Vector3d sides = box.sizes();
  return concatenate(std::setprecision(3), sides.x(), " x ", sides.y(), " x ", sides.z());
}

std::string doubt_about_organ(const std::string& organ, const Eigen::AlignedBox3d& box) {
  return doubt_about(concatenate("organ '", organ, "' is ", sides_of(box), " m large"),
                     box.sizes().maxCoeff(), kSmallestOrgan, kLargestOrgan);
}

std::string doubt_about_radius(const std::string& whose, double radius) {
  return doubt_about(concatenate(whose, " has a radius of ", radius, " m"), radius, kSmallestRadius,
                     kLargestRadius);
}

std::string doubt_about_link(const std::string& tool, const std::string& link, double size) {
  return doubt_about(concatenate("link '", link, "' of tool '", tool, "' is ", size, " m long"),
                     size, kSmallestLink, kLargestLink);
}

std::string doubt_about_distance(const std::string& tool, const std::string& organ,
                                 double distance) {
  return doubt_about(
      concatenate("tool '", tool, "' is ", distance, " m away from organ '", organ, "'"), distance,
      0.0, kLargestDistance);
}

}  // namespace organ_collision
