#include "plausible_size.hpp"

#include <iomanip>

#include "geometry/concatenate.hpp"

namespace organ_collision {
namespace {

/// What to do about a length, if it is implausible.
std::string advice(double length, double smallest, double largest) {
  const std::string range =
      concatenate("; plausible are ", smallest, " to ", largest, " m. Lengths are in metres: ");
  return range + (length > largest ? "are these millimetres?"
                                   : "were they converted from millimetres twice?");
}

}  // namespace

std::string sides_of(const Eigen::AlignedBox3d& box) {
  const Eigen::Vector3d sides = box.sizes();
  return concatenate(std::setprecision(3), sides.x(), " x ", sides.y(), " x ", sides.z());
}

std::string doubt_about_organ(const std::string& organ, const Eigen::AlignedBox3d& box) {
  using namespace plausible;
  const double longest = box.sizes().maxCoeff();
  if (longest >= kSmallestOrgan && longest <= kLargestOrgan) return {};
  return concatenate("organ '", organ, "' is ", sides_of(box), " m large") +
         advice(longest, kSmallestOrgan, kLargestOrgan);
}

std::string doubt_about_radius(const std::string& tool, double radius) {
  using namespace plausible;
  if (radius >= kSmallestRadius && radius <= kLargestRadius) return {};
  return concatenate("tool '", tool, "' has a radius of ", radius, " m") +
         advice(radius, kSmallestRadius, kLargestRadius);
}

}  // namespace organ_collision
