#include "deformable_organ.hpp"

#include <Eigen/Core>
#include <cmath>
#include <new>
#include <utility>

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

std::shared_ptr<TriangleMesh> ShapePool::take(const TriangleMesh& model) {
  if (auto shape = unused_->take()) return lend(std::move(shape));
  return lend(std::make_unique<TriangleMesh>(model));
}

std::shared_ptr<TriangleMesh> ShapePool::add(TriangleMesh mesh) {
  return lend(std::make_unique<TriangleMesh>(std::move(mesh)));
}

std::shared_ptr<TriangleMesh> ShapePool::lend(std::unique_ptr<TriangleMesh> shape) const {
  const auto give_back = [unused = unused_](TriangleMesh* released) {
    unused->give_back(std::unique_ptr<TriangleMesh>(released));
  };
  return {shape.release(), give_back};
}

std::unique_ptr<TriangleMesh> ShapePool::Unused::take() {
  const std::lock_guard<std::mutex> lock(mutex);
  if (shapes.empty()) return nullptr;
  std::unique_ptr<TriangleMesh> shape = std::move(shapes.back());
  shapes.pop_back();
  return shape;
}

void ShapePool::Unused::give_back(std::unique_ptr<TriangleMesh> shape) {
  try {
    const std::lock_guard<std::mutex> lock(mutex);
    shapes.push_back(std::move(shape));
  } catch (const std::bad_alloc&) {  // The shape's memory is released instead.
  }
}

DeformableOrgan::DeformableOrgan(std::string name, std::string frame, TriangleMesh mesh,
                                 ros::Time stamp, ros::Time received)
    : name_(std::move(name)), frame_(std::move(frame)) {
  replace(std::move(mesh), stamp, received);
}

void DeformableOrgan::move(SharedVertices vertices, ros::Time stamp, ros::Time received) {
  const std::shared_ptr<TriangleMesh> shape = shapes_.take(*latest_.mesh);
  shape->move_vertices(std::move(vertices));
  previous_ = std::move(latest_);
  latest_ = {shape, stamp, received, previous_.surface};
}

void DeformableOrgan::replace(TriangleMesh mesh, ros::Time stamp, ros::Time received) {
  // First what may fail for lack of memory, so that the organ then stays as it was.
  ShapePool shapes;
  const std::shared_ptr<TriangleMesh> shape = shapes.add(std::move(mesh));
  auto surface = std::make_shared<OrganSurface>(*shape);
  shapes_ = std::move(shapes);
  previous_ = {};
  latest_ = {shape, stamp, received, std::move(surface)};
}

}  // namespace organ_collision
