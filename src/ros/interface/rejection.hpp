#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace organ_collision {

/// A message or request that was refused. what() names the value and what is legal.
class Rejection : public std::runtime_error {
 public:
  /// `status`: as in ContactArray. `reason`: short, the same for all of its kind, for counting.
  Rejection(std::uint8_t status, std::string reason, const std::string& message)
      : std::runtime_error(message), status_(status), reason_(std::move(reason)) {}

  std::uint8_t status() const { return status_; }
  const std::string& reason() const { return reason_; }

 private:
  std::uint8_t status_;
  std::string reason_;
};

/// Throws Rejection where an organ, a tool or a frame has no legal name (plain_text.hpp), as "WHAT
/// 'NAME' ...". An empty name passes.
void check_name(const std::string& what, const std::string& name);

}  // namespace organ_collision
