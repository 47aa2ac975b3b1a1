#pragma once

namespace organ_collision {

/// Lowers the priority of the calling thread (niceness 10): if all processors are busy, the thread
/// that answers queries comes first. If the system refuses, the thread keeps its priority.
void lower_priority_of_this_thread();

/// Lets the calling thread run only where no other thread wants a processor (SCHED_IDLE). It must
/// not hold locks that another thread needs soon. If the system refuses, the thread keeps its
/// priority.
void yield_to_all_threads();

}  // namespace organ_collision
