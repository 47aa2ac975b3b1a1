#pragma once

#include <organ_collision/ProxyContact.h>

#include <vector>

#include "organ_collision/query/haptic_proxy.hpp"
#include "tool_proxy.hpp"

namespace organ_collision {

/// What ProxyState.contacts and hand_contacts have: the places of `contacts`, the nearest first,
/// each with the published force of the proxy on it. `report`: with an answer.
std::vector<ProxyContact> places_of(const ProxyReport& report,
                                    const std::vector<ProxyFace>& contacts);

}  // namespace organ_collision
