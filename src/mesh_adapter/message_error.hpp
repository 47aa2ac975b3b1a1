#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace organ_collision {

/// A message that cannot be read as a surface. what() names the illegal value and what is legal.
class MessageError : public std::runtime_error {
 public:
  /// `reason`: a short text that is the same for all errors of one kind. Errors are counted by
  /// reason.
  MessageError(std::string reason, const std::string& message)
      : std::runtime_error(message), reason_(std::move(reason)) {}

  const std::string& reason() const { return reason_; }

 private:
  std::string reason_;
};

}  // namespace organ_collision
