#include "thread_priority.hpp"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace organ_collision {

void lower_priority_of_this_thread() {
  constexpr int kNiceness = 10;  // From 0 (ordinary) to 19.
  // On Linux, each thread has a niceness of its own.
  setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNiceness);
}

}  // namespace organ_collision
