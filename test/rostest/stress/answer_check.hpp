#pragma once

#include <organ_collision/ContactArray.h>

#include <string>

namespace organ_collision::stress {

/// What an answer breaks of the contract of ContactArray.msg, or an empty text: an answer has a
/// status of the message. If that is OK, the contacts are sorted, belong to one of the links and
/// are finite; else there are none, and the message says why. Of clearance and placement, nothing
/// is checked.
std::string broken_contract(const ContactArray& answer);

}  // namespace organ_collision::stress
