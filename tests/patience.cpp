// Preloaded into the programs of tests. A rank of Open MPI that waits yields the processor between looks for messages. Where
// other programs run, too, it may get the processor back some milliseconds later, each time. After such a yield it sleeps
// for some microseconds instead, and is back at once.
#include <chrono>
#include <sched.h>
#include <sys/syscall.h>
#include <thread>
#include <unistd.h>

extern "C" int sched_yield() noexcept {
  using namespace std::chrono;
  thread_local int n_sleeps = 0;
  if (n_sleeps > 0) {
    --n_sleeps;
    std::this_thread::sleep_for(microseconds(20));
    return 0;
  }
  const auto begin = steady_clock::now();
  const auto status = syscall(SYS_sched_yield);
  if (steady_clock::now() - begin > milliseconds(1)) n_sleeps = 200;
  return static_cast<int>(status);
}
