#include "rejection.hpp"

#include <organ_collision/ContactArray.h>

#include "plain_text.hpp"

namespace organ_collision {

void check_name(const std::string& what, const std::string& name) {
  const std::string fault = name_fault(name);
  if (fault.empty()) return;
  throw Rejection(ContactArray::INVALID_REQUEST, "illegal name", what + " " + fault);
}

}  // namespace organ_collision
