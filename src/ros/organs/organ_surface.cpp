#include "organ_surface.hpp"

#include <Eigen/Core>
#include <cmath>

namespace organ_collision {
namespace {

/// [1] A smaller share of the cube of the organ's size is no volume but rounding, as between the
/// two sides of a sheet.
constexpr double kNoVolume = 1e-9;

/// [m] The longest side of the box around all vertices.
double size_of(const std::vector<float>& vertices) {
  const Eigen::Map<const Eigen::Matrix3Xf> points(vertices.data(), 3,
                                                  static_cast<Eigen::Index>(vertices.size() / 3));
  const Eigen::Vector3d low = points.rowwise().minCoeff().cast<double>();
  return (points.rowwise().maxCoeff().cast<double>() - low).maxCoeff();
}

}  // namespace

void OrganSurface::find() {
  if (found_) return;
  try {
    find_all();
  } catch (...) {
    set_ended();
    throw;
  }
  set_ended();
}

void OrganSurface::find_all() {
  topology_.emplace(*faces_, *vertices_);
  inward_ = volume(*vertices_) < -kNoVolume * std::pow(size_of(*vertices_), 3);
  vertices_.reset();
  found_ = true;
}

void OrganSurface::set_ended() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
  }
  has_ended_.notify_all();
}

bool OrganSurface::wait_until_found(std::chrono::milliseconds longest) const {
  if (found_) return true;
  std::unique_lock<std::mutex> lock(mutex_);
  has_ended_.wait_for(lock, longest, [this] { return ended_; });
  return found_;
}

}  // namespace organ_collision
