// Use of one thread at a time, the same on all ranks.
#pragma once

#include "bindings.hpp"

#include <functional>
#include <string>

namespace sprekk::python {

/// Lock of the library, because MUMPS, timers and MPI permit one thread at a time. Create it while holding the
/// interpreter lock, which is released while this thread waits.
class Alone {
 public:
  Alone();
  ~Alone();
  Alone(const Alone&) = delete;
  Alone& operator=(const Alone&) = delete;
};

/// Throws an Error on all ranks if `text` differs between ranks. The message begins with `name` and contains the first
/// different line. Collective.
void check_same(const Comm& comm, const std::string& name, const std::string& text);

/// Runs work(), which reads Python objects. An exception on one rank becomes an Error on the others. Collective.
void from_python(const Comm& comm, const std::function<void()>& work);

/// Throws an Error unless one thread uses all models on several ranks. With more threads, ranks could wait for each
/// other in different models. Collective.
void check_thread(const Comm& comm);

}  // namespace sprekk::python
