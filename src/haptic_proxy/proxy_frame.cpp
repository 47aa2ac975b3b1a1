#include "proxy_frame.hpp"

#include <algorithm>

namespace organ_collision {

bool ProxyFrame::update(const OrganRegistry& organs) {
  const auto& all = organs.organs();
  if (fixed_ || all.empty()) return false;
  const bool is_used = std::any_of(
      all.begin(), all.end(), [this](const auto& organ) { return organ.second.frame() == name_; });
  if (is_used) return false;
  name_ = all.begin()->second.frame();
  return true;
}

}  // namespace organ_collision
