#include "place_rules.hpp"

#include <Eigen/Core>
#include <cmath>

#include "ros/interface/conversions.hpp"

namespace organ_collision {
namespace {

/// [1] Lengths of normals, and barycentric coordinates, may be rounded by this much.
constexpr double kRounding = 1e-6;
/// The largest legal value of the node's parameter max_faces.
constexpr std::uint32_t kMostFaces = 83333333;

}  // namespace

std::ostream& operator<<(std::ostream& stream, const CheckedPlace& place) {
  return stream << place.list << '[' << place.index << "] (face " << place.face << ')';
}

void check_finite(const CheckedPlace& place, const char* field, double value, Faults& faults) {
  if (std::isfinite(value)) return;
  faults.add("finite numbers", field, " of ", place, " is ", value, "; must be finite");
}

void check_finite(const CheckedPlace& place, const char* field, const geometry_msgs::Point& value,
                  Faults& faults) {
  const Eigen::Vector3d point = to_eigen(value);
  if (point.allFinite()) return;
  faults.add("finite numbers", field, " of ", place, " is ", point.transpose(), "; must be finite");
}

void check_share(const CheckedPlace& place, const char* field, double value, Faults& faults) {
  if (value >= 0.0 && value <= 1.0) return;
  faults.add("shares", field, " of ", place, " is ", value, "; must be from 0 to 1");
}

void check_unit(const CheckedPlace& place, const geometry_msgs::Vector3& normal, Faults& faults) {
  const Eigen::Vector3d vector = to_eigen(normal);
  if (std::abs(vector.norm() - 1.0) <= kRounding) return;
  faults.add("unit normals", "normal of ", place, " is ", vector.transpose(), ", of length ",
             vector.norm(), "; must be 1");
}

void check_barycentric(const CheckedPlace& place, const boost::array<double, 3>& barycentric,
                       Faults& faults) {
  const Eigen::Map<const Eigen::Vector3d> shares(barycentric.data());
  const bool is_inside = shares.minCoeff() >= -kRounding && shares.maxCoeff() <= 1.0 + kRounding;
  if (shares.allFinite() && is_inside && std::abs(shares.sum() - 1.0) <= kRounding) return;
  faults.add("barycentric coordinates", "barycentric of ", place, " is ", shares.transpose(),
             "; must be from 0 to 1 each, and 1 together");
}

void check_link(const CheckedPlace& place, std::uint32_t link, std::size_t links, Faults& faults) {
  if (link < links) return;
  faults.add("indices", "link of ", place, " is ", link, "; `links` has ", links, " names");
}

void check_face(const CheckedPlace& place, Faults& faults) {
  if (place.face < kMostFaces) return;
  faults.add("indices", place, ": no organ may have more than ", kMostFaces, " faces");
}

}  // namespace organ_collision
