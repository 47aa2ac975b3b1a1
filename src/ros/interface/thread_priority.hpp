#pragma once

namespace organ_collision {

/// Lowers the priority of the calling thread (niceness 10): if all processors are busy, the thread
/// that answers queries comes first. If the system refuses, the thread keeps its priority.
void lower_priority_of_this_thread();

}  // namespace organ_collision
