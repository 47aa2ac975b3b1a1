#pragma once

#include <memory>
#include <vector>

#include "tissue.hpp"

namespace organ_collision {

/// The motion of organs in one tick, cut into pieces of equal duration. In each, the organs move
/// linearly from the last piece's end.
class OrganPieces {
 public:
  OrganPieces(const std::vector<OrganTick>& organs, int pieces);

  /// The organs in a piece. They refer to this object and to the shapes that it was made of.
  std::vector<OrganTick> piece(int piece) const;

 private:
  std::vector<OrganTick> organs_;
  int pieces_;
  /// By organ and end of piece: the shapes between before and now. Empty for an organ whose shape
  /// does not change.
  std::vector<std::vector<std::unique_ptr<const TriangleMesh>>> between_;
};

}  // namespace organ_collision
