#pragma once

#include <memory>
#include <vector>

#include "organ_collision/query/collision_query.hpp"
#include "picking/pickers/picker.hpp"
#include "picking/volumes/viewing_volume.hpp"
#include "tally.hpp"
#include "trials.hpp"

namespace organ_collision::oracle {

/// The largest difference between an answer and the exact one that rounding may explain [m].
inline constexpr double kBand = 1e-9;

/// Asks the library and the oracles the same questions. Prints every trial in which they differ by
/// more than the tolerance.
class Comparison {
 public:
  Comparison();

  /// Compares with exact distances: the tool at rest at the end of its motion, or swept. If the
  /// library or the oracle says that the face touches, all pickers must find it.
  Tally at_rest(const Trial& trial);
  Tally swept(const Trial& trial);

  /// Compares what all pickers find with the exact half-spaces of a volume.
  Tally volume(const ViewingVolume& volume, const Trial& trial);

  /// Compares the whole query with a search, while the face and the trocar move, too.
  Tally moving(const Trial& trial, Random& random);

 private:
  Tally capsule(const ShaftMotion& motion, const Trial& trial);

  std::vector<std::unique_ptr<Picker>> pickers_;  ///< one of each kind
  CollisionQuery query_;
};

}  // namespace organ_collision::oracle
