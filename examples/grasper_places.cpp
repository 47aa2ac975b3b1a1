#include "grasper_places.hpp"

#include <algorithm>
#include <cmath>

namespace grasper {
namespace {

/// [m per rad, or 1] About how far the tip goes if a joint moves.
const Joints kReach = (Joints() << 0.15, 0.15, 1.0, 0.02, 0.03, 0.03).finished();

}  // namespace

Eigen::Isometry3d trocar() {
  const Eigen::Quaterniond rotation(0.0894354727, -0.0413637326, -0.9032105840, -0.4177331430);
  return Eigen::Translation3d(0.02, -0.12, 0.10) * rotation.normalized();
}

Joints joints_at(const Place& place) { return place.cwiseQuotient(kReach); }
Place place_of(const Joints& joints) { return joints.cwiseProduct(kReach); }

Path straight(const Place& a, const Place& b, double piece) {
  const int count = std::max(1, static_cast<int>(std::ceil((b - a).norm() / piece)));
  Path places;
  for (int i = 0; i < count; ++i) places.push_back(a + (b - a) * i / count);
  places.push_back(b);
  return places;
}

Path straight(const Path& path, double piece) {
  Path places{path.front()};
  for (std::size_t leg = 1; leg < path.size(); ++leg) {
    const Path of_leg = straight(path[leg - 1], path[leg], piece);
    places.insert(places.end(), of_leg.begin() + 1, of_leg.end());
  }
  return places;
}

}  // namespace grasper
