#include "base/memory.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>

#include "base/timer.hpp"

namespace sprekk::base {

namespace {

constexpr double GB = 1e9;

/// Returns the number of bytes in a system file; infinity if it contains no number.
double bytes_in(const char* path) {
  double bytes = 0;
  return std::ifstream(path) >> bytes ? bytes : std::numeric_limits<double>::infinity();
}

}  // namespace

double memory_limit() {
  double limit = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  rlimit own{};
  if (getrlimit(RLIMIT_AS, &own) == 0 && own.rlim_cur != RLIM_INFINITY)
    limit = std::min(limit, static_cast<double>(own.rlim_cur));
  for (const char* group : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"})
    limit = std::min(limit, bytes_in(group));
  return limit;
}

std::string out_of_memory() {
  return fmt::format(
      "out of memory: this process has taken {:.2g} GB, all processes of this machine together may take {:.2g} GB; "
      "take fewer cells, or more machines",
      static_cast<double>(peak_memory_bytes()) / GB, memory_limit() / GB);
}

}  // namespace sprekk::base
