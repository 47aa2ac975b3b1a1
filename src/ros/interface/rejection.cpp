#include "rejection.hpp"

#include <organ_collision/ContactArray.h>

#include "legal_name.hpp"

namespace organ_collision {

std::string reason_of(std::uint8_t status) {
  switch (status) {
    case ContactArray::OK:
      return "ok";
    case ContactArray::NO_MESH:
      return "no mesh";
    case ContactArray::NO_TRANSFORM:
      return "no transform";
    case ContactArray::STALE_MESH:
      return "stale mesh";
    case ContactArray::UNKNOWN_ORGAN:
      return "unknown organ";
    case ContactArray::UNKNOWN_TOOL:
      return "unknown tool";
    case ContactArray::PICKER_FAILED:
      return "picker failed";
    case ContactArray::INVALID_TOOL:
      return "invalid tool";
    default:
      return "invalid request";
  }
}

void check_name(const std::string& what, const std::string& name) {
  const std::string fault = name_fault(name);
  if (fault.empty()) return;
  throw Rejection(ContactArray::INVALID_REQUEST, "illegal name", what + " " + fault);
}

}  // namespace organ_collision
