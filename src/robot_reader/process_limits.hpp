#pragma once

namespace organ_collision {

/// Binds this process to reader_limits, and to leaving no core file. Throws std::system_error.
void limit_process();

}  // namespace organ_collision
