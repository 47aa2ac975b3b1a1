#pragma once

#include <memory>

#include "organ_collision/query/collision_query.hpp"
#include "picking/gl/gl_context.hpp"
#include "picking/pickers/picker.hpp"
#include "picking/volumes/viewing_volume.hpp"
#include "tally.hpp"
#include "trials.hpp"

namespace organ_collision::oracle {

/// [m] Farthest that an answer may be from the exact one.
inline constexpr double kBand = 1e-9;

/// Puts the same questions to the library and to the oracles. Prints every trial on which they
/// differ by more than the band.
class Comparison {
 public:
  Comparison();

  /// The tool at rest at the end of its motion, or swept, against exact distances; and whether both
  /// pickers find the face if either says that it touches.
  Tally at_rest(const Trial& trial);
  Tally swept(const Trial& trial);

  /// What both pickers find against the exact half-spaces of a volume.
  Tally volume(const ViewingVolume& volume, const Trial& trial);

  /// Face and trocar move as well: the whole query against search.
  Tally moving(const Trial& trial, Random& random);

 private:
  Tally capsule(const ShaftMotion& motion, const Trial& trial);

  GlContext context_;
  std::unique_ptr<Picker> feedback_, select_;
  CollisionQuery query_;
};

}  // namespace organ_collision::oracle
