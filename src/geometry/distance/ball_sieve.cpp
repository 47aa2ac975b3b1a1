#include "ball_sieve.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "geometry/lanes.hpp"

namespace organ_collision {
namespace {

/// [1] Allowance for rounding, as a share of the magnitudes of a ball's coordinates and its radius,
/// or of a bound of a box. Some eight operations in 32 bits, each with a relative error of 2^-24,
/// lead to a comparison.
constexpr double kRounding = 1e-6;

/// What a box covers along one of its axes.
struct Slab {
  float x, y, z;  ///< the axis
  float low, high;
};

Slab slab(const Slabs& box, std::size_t number, const Eigen::Vector3d& origin) {
  const auto i = static_cast<Eigen::Index>(number);
  const Eigen::Vector3d axis = box.axes.col(i);
  const double low = box.low[i] - axis.dot(origin), high = box.high[i] - axis.dot(origin);
  return {static_cast<float>(axis.x()), static_cast<float>(axis.y()), static_cast<float>(axis.z()),
          static_cast<float>(low - kRounding * std::abs(low)),
          static_cast<float>(high + kRounding * std::abs(high))};
}

}  // namespace

void BallSieve::clear(const Eigen::Vector3d& origin) {
  origin_ = origin;
  balls_.clear();
  numbers_.clear();
}

void BallSieve::add(const Eigen::Vector3d& center, double radius) {
  const Eigen::Vector3d place = center - origin_;
  const double grown = radius + kRounding * (place.cwiseAbs().sum() + radius);
  numbers_.push_back(static_cast<std::uint32_t>(balls_.size()));
  balls_.push_back({static_cast<float>(place.x()), static_cast<float>(place.y()),
                    static_cast<float>(place.z()), static_cast<float>(grown)});
}

void BallSieve::remove(std::uint32_t number) {
  balls_[number].radius = -std::numeric_limits<float>::infinity();
}

BallSieve::Range BallSieve::sift(const Range& range, const Slabs& box) {
  std::array<Slab, 3> slabs;
  for (std::size_t i = 0; i < slabs.size(); ++i) slabs[i] = slab(box, i, origin_);
  const std::size_t begin = numbers_.size();
  // The last lanes may lie behind the range. What they hold does not matter.
  numbers_.resize(begin + range.size() + kLanes);
  std::size_t end = begin;
  for (std::size_t place = range.begin; place < range.end; place += kLanes) {
    std::array<std::uint32_t, kLanes> number;
    std::copy_n(numbers_.begin() + static_cast<std::ptrdiff_t>(place), kLanes, number.begin());
    const std::size_t count = std::min(kLanes, range.end - place);
    for (std::size_t i = count; i < kLanes; ++i) number[i] = number[0];
    const Ball &a = balls_[number[0]], &b = balls_[number[1]], &c = balls_[number[2]],
               &d = balls_[number[3]];
    const Lanes x{a.x, b.x, c.x, d.x}, y{a.y, b.y, c.y, d.y}, z{a.z, b.z, c.z, d.z};
    const Lanes radius{a.radius, b.radius, c.radius, d.radius};
    LaneCodes meets = {-1, -1, -1, -1};
    for (const Slab& slab : slabs) {
      const Lanes along = slab.x * x + slab.y * y + slab.z * z;
      meets &= (along - radius <= slab.high) & (along + radius >= slab.low);
    }
    for (std::size_t i = 0; i < count; ++i) {
      numbers_[end] = number[i];
      end += static_cast<std::size_t>(meets[i] & 1);
    }
  }
  numbers_.resize(end);
  return {begin, end};
}

}  // namespace organ_collision
