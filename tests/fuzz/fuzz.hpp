// Tests a reader with damaged files; each must be read or give an Error.
#pragma once

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <functional>
#include <iostream>
#include <string>

#include "base/check.hpp"
#include "mutate.hpp"

namespace sprekk::fuzz {

/// Results of the reading child process in shared memory, available also after a crash.
struct Progress {
  long next, n_read, n_refused;
};

/// Reads the inputs from progress.next up to `end`; exits with 0, or with 1 after a wrong result.
[[noreturn]] inline void read_all(const char* name, const std::vector<std::string>& texts, long end,
                                  const std::function<std::string(const std::string&, const std::string&)>& read,
                                  Progress& progress) {
  constexpr unsigned time_limit = 60;  // seconds for one input
  for (; progress.next < end; ++progress.next) {
    alarm(time_limit);
    const auto& text = texts[progress.next % texts.size()];
    std::string defect;
    try {
      defect = read(text, Mutator(progress.next).damaged(text));
      progress.n_read += defect.empty();
    } catch (const Error&) {
      ++progress.n_refused;
    } catch (const std::exception& error) {
      defect = std::string("not an Error: ") + error.what();
    }
    if (defect.empty()) continue;
    std::cerr << name << ": " << defect << std::endl;
    _exit(1);
  }
  _exit(0);
}

/// Main program NAME FOLDER COUNT [FIRST]: damages files *`ending` of a folder in COUNT ways and calls
/// `read`(undamaged, damaged), which returns the defect of its result. Reading runs in a child process, so that a
/// crash or time-out affects only one input. FIRST is the number of an input, to repeat it.
inline int run(int argc, char** argv, const char* name, const char* ending,
               const std::function<std::string(const std::string&, const std::string&)>& read) {
  const auto texts = argc > 2 ? contents(argv[1], ending) : std::vector<std::string>();
  const long count = argc > 2 ? std::atol(argv[2]) : 0, first = argc > 3 ? std::atol(argv[3]) : 0;
  void* shared = mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (texts.empty() || count <= 0 || shared == MAP_FAILED) {
    std::cerr << "usage: " << name << " FOLDER COUNT [FIRST]; FOLDER has files *" << ending << "\n";
    return 2;
  }
  auto& progress = *new (shared) Progress{first, 0, 0};
  long n_crashes = 0;
  while (progress.next < first + count) {
    const pid_t child = fork();
    if (child < 0) return 2;
    if (child == 0) read_all(name, texts, first + count, read, progress);
    int status = 0;
    waitpid(child, &status, 0);
    if (status == 0) break;
    std::cerr << name << ": the reader failed at input " << progress.next << " of these, " << texts.size()
              << " files in turn" << (WIFSIGNALED(status) ? ", by a signal" : "") << std::endl;
    ++progress.next;
    ++n_crashes;
  }
  std::cout << name << ": " << count << " inputs, " << progress.n_read << " read, " << progress.n_refused
            << " refused, " << n_crashes << " crashes" << std::endl;
  return n_crashes > 0;
}

}  // namespace sprekk::fuzz
