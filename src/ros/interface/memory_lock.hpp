#pragma once

#include <string>

namespace organ_collision {

/// Keeps all memory of the process in RAM until the process ends: what it has now at once, and what
/// it takes later page by page, when a page is first used.
/// Returns why the system refuses; empty: it did not. A limit of locked memory counts as a refusal:
/// beyond it, the process would get no more memory at all.
std::string lock_memory();

/// [bytes] How much memory of the process is locked.
long long locked_memory();

}  // namespace organ_collision
