#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace organ_collision {

/// A message or request that was refused. what() names the illegal value and what is legal.
class Rejection : public std::runtime_error {
 public:
  /// `status`: one of ContactArray's. `reason`: a short text that is the same for all refusals of
  /// one kind. Refusals are counted by reason.
  Rejection(std::uint8_t status, std::string reason, const std::string& message)
      : std::runtime_error(message), status_(status), reason_(std::move(reason)) {}

  std::uint8_t status() const { return status_; }
  const std::string& reason() const { return reason_; }

 private:
  std::uint8_t status_;
  std::string reason_;
};

/// The reason under which failures with this status of ContactArray are counted, for example
/// "no mesh".
std::string reason_of(std::uint8_t status);

/// Throws Rejection, with the message "WHAT 'NAME' ...", if `name` is not legal (legal_name.hpp).
/// `what`: the thing that has the name, for example "organ". An empty name is accepted.
void check_name(const std::string& what, const std::string& name);

}  // namespace organ_collision
