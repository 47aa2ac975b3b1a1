#pragma once

#include <string>

#include "ros/organs/organ_registry.hpp"

namespace organ_collision {

/// The TF frame in which proxies move.
class ProxyFrame {
 public:
  /// `fixed`: the frame; empty: that of the first organ.
  explicit ProxyFrame(std::string fixed) : fixed_(!fixed.empty()), name_(std::move(fixed)) {}

  /// Empty: there was no organ yet.
  const std::string& name() const { return name_; }

  /// A frame that was chosen stays as long as an organ has it, or if no organ is left. Returns
  /// whether another frame was chosen.
  bool update(const OrganRegistry& organs);

 private:
  bool fixed_;
  std::string name_;
};

}  // namespace organ_collision
