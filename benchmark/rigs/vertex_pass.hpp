#pragma once

#include <Eigen/Core>
#include <vector>

namespace organ_collision::bench {

/// The least that anything can do that reads new vertices: boxes of runs of 16.
class VertexPass {
 public:
  static constexpr std::size_t kBlock = 16;

  /// `vertices`: x y z x y z ... [m]; a last run of fewer vertices has a box as well.
  void fit(const std::vector<float>& vertices);

  /// Corners of each run's box.
  const std::vector<Eigen::Array3f>& low() const { return low_; }
  const std::vector<Eigen::Array3f>& high() const { return high_; }

 private:
  std::vector<Eigen::Array3f> low_, high_;
};

}  // namespace organ_collision::bench
