#include "thread_priority.hpp"

#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace organ_collision {

void lower_priority_of_this_thread() {
  constexpr int kNiceness = 10;  // From 0 (ordinary) to 19.
  // On Linux, each thread has a niceness of its own.
  setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNiceness);
}

void yield_to_all_threads() {
  const sched_param parameters{};
  sched_setscheduler(0, SCHED_IDLE, &parameters);
}

}  // namespace organ_collision
