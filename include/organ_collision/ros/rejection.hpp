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

}  // namespace organ_collision
