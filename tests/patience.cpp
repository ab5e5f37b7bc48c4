// Library preloaded into test programs. A waiting rank of Open MPI yields the processor between checks for messages.
// When other programs run, the rank may get the processor back only after milliseconds, each time. After such a yield,
// this library sleeps for some microseconds instead and returns quickly.
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
