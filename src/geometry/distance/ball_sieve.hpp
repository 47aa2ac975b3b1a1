#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace organ_collision {

/// A box: three directions, the columns of `axes`, which are not longer than 1, and the least and
/// the greatest axis · point [m].
struct Slabs {
  Eigen::Matrix3d axes;
  Eigen::Vector3d low, high;
};

/// Sifts balls by boxes: of some balls, finds those that may meet a box, four at a time. It
/// computes in 32 bits and allows for their rounding: no ball that meets the box is left out,
/// unless it was removed. Keeps its memory.
///
/// What it finds is listed behind what was found before, as on a stack: a walk down a tree sifts
/// what it has sifted above, and forgets it on the way back.
class BallSieve {
 public:
  /// Consecutive places in the sieve's list of balls.
  struct Range {
    std::size_t begin, end;

    std::size_t size() const { return end - begin; }
    bool empty() const { return begin == end; }
  };

  /// Starts anew without balls. All coordinates are in one frame [m]. The allowance for rounding is
  /// smallest for balls near `origin`.
  void clear(const Eigen::Vector3d& origin);
  /// Adds a ball [m]: finite, its radius not negative. Balls have numbers, from 0 on. Only before
  /// the first call of sift().
  void add(const Eigen::Vector3d& center, double radius);
  /// From now on, sift() leaves a ball out.
  void remove(std::uint32_t number);
  /// All balls.
  Range all() const { return {0, balls_.size()}; }

  /// Lists the balls of a range that may meet a box, behind all that is listed.
  Range sift(const Range& range, const Slabs& box);
  /// Takes those balls out of the last range listed for whose number `is_kept` is false.
  template <typename IsKept>
  void keep_if(Range& last, IsKept is_kept);
  /// Takes the last range listed off the list.
  void forget(const Range& last) { numbers_.resize(last.begin); }

  /// The number of the ball at a place of the list.
  std::uint32_t number(std::size_t place) const { return numbers_[place]; }

 private:
  /// Relative to the origin [m]. The radius includes the allowance for rounding.
  struct Ball {
    float x, y, z, radius;
  };

  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  std::vector<Ball> balls_;             ///< by number
  std::vector<std::uint32_t> numbers_;  ///< the list
};

template <typename IsKept>
void BallSieve::keep_if(Range& last, IsKept is_kept) {
  const auto begin = numbers_.begin() + static_cast<std::ptrdiff_t>(last.begin);
  numbers_.erase(
      std::remove_if(begin, numbers_.end(), [&](std::uint32_t number) { return !is_kept(number); }),
      numbers_.end());
  last.end = numbers_.size();
}

}  // namespace organ_collision
