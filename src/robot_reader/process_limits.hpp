#pragma once

namespace organ_collision {

/// Applies reader_limits to this process, and stops it from dumping core. Throws std::system_error.
void limit_process();

}  // namespace organ_collision
