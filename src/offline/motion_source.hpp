#pragma once

#include <optional>
#include <string>

#include "motion.hpp"

namespace organ_collision {

/// Gives motions in the order in which they are answered.
class MotionSource {
 public:
  virtual ~MotionSource() = default;

  /// The next motion, or none after the last one. May wait for it. Throws InputError if it is not
  /// legal.
  virtual std::optional<Motion> next() = 0;
  /// Whether next() returns without waiting.
  virtual bool is_ready() = 0;
  /// Where the motions come from, for messages.
  virtual const std::string& name() const = 0;
};

}  // namespace organ_collision
