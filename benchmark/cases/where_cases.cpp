#include "where_cases.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "cases.hpp"
#include "geometry/distance/closest_points.hpp"

namespace organ_collision::bench {
namespace {

using Eigen::Vector3d;

constexpr double kTolerance = 1e-5;  // [m] FCL stops at 1e-6 m, Embree computes in 32 bits

double radius_of(const Scene& scene) { return scene.steps.front().static_query.query.radius; }

/// The answers of brute force over all faces.
struct Truth {
  double shaft_distance = INFINITY;  ///< [m] from the axis
  double tip_distance = INFINITY;    ///< [m]
  double winding = 0.0;              ///< by the solid angles (Van Oosterom and Strackee 1983)
};

Truth brute_force(const ShaftAxis& axis, const OrganSurface& organ,
                  const std::vector<float>& vertices) {
  constexpr double kSphere = 4.0 * 3.14159265358979323846;
  Truth truth;
  for (std::size_t i = 0; i < organ.face_count(); ++i) {
    const Triangle face = corners(organ, vertices, i);
    truth.shaft_distance = std::min(truth.shaft_distance, closest_points(axis, face).distance);
    truth.tip_distance =
        std::min(truth.tip_distance, closest_points(ShaftAxis{axis.tip, axis.tip}, face).distance);
    const Vector3d a = face[0] - axis.tip, b = face[1] - axis.tip, c = face[2] - axis.tip;
    const double below = a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                         b.dot(c) * a.norm() + c.dot(a) * b.norm();
    truth.winding += 2.0 * std::atan2(a.dot(b.cross(c)), below) / kSphere;
  }
  return truth;
}

bool is_right(std::optional<double> told, double truth) {
  if (!told) return true;
  if (std::isinf(*told)) return truth > kWhereLimit - kTolerance;
  // A tool that touches may be told as one distance below zero, whatever its depth is.
  return std::abs(std::max(*told, 0.0) - std::max(truth, 0.0)) <= kTolerance;
}

}  // namespace

std::vector<ShaftAxis> where_axes(const Scene& scene) {
  constexpr std::array<double, 4> kDrawnBack = {0.0, 0.017, 0.027, 0.052};  // [m]
  std::vector<ShaftAxis> axes;
  for (const SceneStep& step : scene.steps) {
    ShaftAxis axis = step.static_query.query.motion.end;
    axis.tip -= kDrawnBack[axes.size() % kDrawnBack.size()] * (axis.tip - axis.trocar).normalized();
    axes.push_back(axis);
  }
  return axes;
}

WhereMeasurement::WhereMeasurement(std::unique_ptr<Locator> locator, const Scene& scene)
    : locator_(std::move(locator)), scene_(scene), axes_(where_axes(scene)) {
  locator_->set_topology(scene.organ);
  const std::size_t affordable = std::max<std::size_t>(200'000 / scene.organ.face_count(), 4);
  const std::size_t checked = std::min(axes_.size(), affordable);
  for (std::size_t i = 0; i < checked; ++i) check(i);
  summary_.hits /= static_cast<double>(checked);
}

void WhereMeasurement::check(std::size_t i) {
  const SharedVertices& shape = scene_.shapes[scene_.steps[i].shape];
  const double radius = radius_of(scene_);
  locator_->update(shape);
  const Location told = locator_->locate(axes_[i], radius);
  const Truth truth = brute_force(axes_[i], scene_.organ, *shape);
  const bool is_inside = std::abs(truth.winding) > 0.5;
  summary_.hits += is_inside;
  const bool right = is_right(told.shaft_distance, truth.shaft_distance - radius) &&
                     is_right(told.tip_distance, truth.tip_distance) &&
                     (!told.tip_inside || *told.tip_inside == is_inside);
  summary_.errors.wrong += !right;
}

double WhereMeasurement::step() {
  const std::size_t i = next_++ % axes_.size();
  Stopwatch watch;
  locator_->update(scene_.shapes[scene_.steps[i].shape]);
  locator_->locate(axes_[i], radius_of(scene_));
  return watch.lap();
}

namespace {

struct LocatorEntry {
  const char* name;
  std::unique_ptr<Locator> (*make)();
  double face_seconds;  ///< [s] rough time of a step, divided by the number of faces
};

constexpr LocatorEntry kLocators[] = {{"ours", make_our_locator, 1e-9},
                                      {"ours_near", make_our_near_locator, 1e-9},
                                      {"fcl", make_fcl_locator, 1e-6},
                                      {"embree", make_embree_locator, 5e-8},
                                      {"cgal", make_cgal_locator, 2e-6}};

/// A round through the scene's steps, or fewer steps, but not fewer than four: they differ in how
/// far the tool is.
std::size_t steps_per_repetition(std::size_t faces, double face_seconds) {
  constexpr double kSeconds = 0.05;
  const double affordable = kSeconds / (face_seconds * static_cast<double>(faces));
  return static_cast<std::size_t>(
      std::clamp(affordable, 4.0, static_cast<double>(step_count(faces))));
}

}  // namespace

void add_where_cases(MeasurementCache& cache, const SceneKey& key) {
  for (const LocatorEntry& entry : kLocators) {
    const auto run = [&cache, entry, key](benchmark::State& state) {
      WhereMeasurement& measurement = cache.where(entry.name, entry.make, key);
      for ([[maybe_unused]] const auto _ : state) state.SetIterationTime(measurement.step());
      count_errors(measurement.summary(), state);
    };
    add_case(case_name("where", entry.name, key),
             steps_per_repetition(key.faces, entry.face_seconds), run);
  }
}

}  // namespace organ_collision::bench
