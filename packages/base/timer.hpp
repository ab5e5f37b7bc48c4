// Wall-clock and CPU time of named phases, and peak memory.
#pragma once

#include <sys/resource.h>

#include <chrono>
#include <cstddef>
#include <ctime>
#include <string>
#include <vector>

namespace sprekk::base {

/// Time of phases on this rank: `auto scope = timers.scope("assembly");` adds the lifetime of `scope`. Phases may be
/// nested; each includes its inner phases.
class Timers {
 public:
  struct Phase {
    std::string name;
    double seconds = 0;      ///< wall-clock time
    double cpu_seconds = 0;  ///< CPU time of this process
    long long count = 0;     ///< number of calls
  };

  class Scope {
   public:
    Scope(Timers& timers, std::size_t phase)
        : timers_(timers), phase_(phase), begin_(Clock::now()), cpu_begin_(std::clock()) {}
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;
    ~Scope() {
      auto& phase = timers_.phases_[phase_];
      phase.seconds += std::chrono::duration<double>(Clock::now() - begin_).count();
      phase.cpu_seconds += static_cast<double>(std::clock() - cpu_begin_) / CLOCKS_PER_SEC;
      ++phase.count;
    }

   private:
    using Clock = std::chrono::steady_clock;
    Timers& timers_;
    std::size_t phase_;
    Clock::time_point begin_;
    std::clock_t cpu_begin_;
  };

  [[nodiscard]] Scope scope(const std::string& name) {
    std::size_t phase = 0;
    while (phase < phases_.size() && phases_[phase].name != name) ++phase;
    if (phase == phases_.size()) phases_.push_back({name});
    return Scope(*this, phase);
  }

  const std::vector<Phase>& phases() const { return phases_; }  ///< in the order of first use

 private:
  std::vector<Phase> phases_;
};

/// Returns the peak memory of this process in bytes.
inline std::size_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

}  // namespace sprekk::base
