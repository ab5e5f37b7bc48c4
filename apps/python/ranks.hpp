// One thread at a time, and the same on all ranks.
#pragma once

#include "bindings.hpp"

#include <functional>
#include <string>

namespace sprekk::python {

/// Holds the lock of the library: MUMPS, timers and MPI allow one thread at a time. To be made while the interpreter's
/// lock is held; other threads may take that one while this thread waits.
class Alone {
 public:
  Alone();
  ~Alone();
  Alone(const Alone&) = delete;
  Alone& operator=(const Alone&) = delete;
};

/// An Error on all ranks unless `text` is the same on all of them, with the first line that differs; `name` opens the
/// message. Collective.
void check_same(const Comm& comm, const std::string& name, const std::string& text);

/// Runs work(), which reads objects of Python. An exception on one rank is an Error on the others. Collective.
void from_python(const Comm& comm, const std::function<void()>& work);

/// An Error unless all models on several ranks are used by the same thread: with more threads, ranks would wait for
/// each other in different models. Collective.
void check_thread(const Comm& comm);

}  // namespace sprekk::python
