#pragma once

#include <Eigen/Core>
#include <vector>

namespace organ_collision::bench {

/// A lower bound for any engine that reads all new vertices: one pass that computes the box of each
/// block of 16 vertices.
class VertexPass {
 public:
  static constexpr std::size_t kBlock = 16;

  /// `vertices`: x y z x y z ... [m]. If the last block has fewer vertices, it has a box, too.
  void fit(const std::vector<float>& vertices);

  /// The corners of each block's box [m].
  const std::vector<Eigen::Array3f>& low() const { return low_; }
  const std::vector<Eigen::Array3f>& high() const { return high_; }

 private:
  std::vector<Eigen::Array3f> low_, high_;
};

}  // namespace organ_collision::bench
