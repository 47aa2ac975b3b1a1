#pragma once

#include <vector>

#include "organ_oracle.hpp"
#include "test/proof/trials.hpp"

namespace organ_collision::oracle {

/// Whether lines could move from one place to another past the tissue, on a few straight legs at
/// random, while the organ moves from its last shape to this one. A proxy that slides along tissue
/// or flies around it moves on several legs in a tick, so the straight motion may cut through
/// tissue that the proxy went around. `holds_trocar`: the first line's trocar only moves straight.
/// If it is the only line, it may also be withdrawn to its trocar, and enter anew.
bool has_detour(const OrganOracle& organ, const std::vector<ShaftAxis>& from,
                const std::vector<ShaftAxis>& to, bool holds_trocar, Random& random);

}  // namespace organ_collision::oracle
