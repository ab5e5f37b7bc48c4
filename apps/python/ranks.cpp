#include "ranks.hpp"

#include "base/check.hpp"
#include "base/over_ranks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <mutex>
#include <sstream>
#include <thread>

namespace sprekk::python {

namespace {

std::recursive_mutex& library() {
  static std::recursive_mutex mutex;
  return mutex;
}

/// Returns the first different line of each text.
std::pair<std::string, std::string> first_difference(const std::string& a, const std::string& b) {
  std::istringstream lines_of_a(a), lines_of_b(b);
  std::pair<std::string, std::string> lines;
  while (lines.first == lines.second) {
    if (!std::getline(lines_of_a, lines.first)) lines.first = "nothing";
    if (!std::getline(lines_of_b, lines.second)) lines.second = "nothing";
  }
  return lines;
}

std::string trimmed(const std::string& line) { return line.substr(std::min(line.find_first_not_of(' '), line.size())); }

}  // namespace

Alone::Alone() {
  if (library().try_lock()) return;
  const py::gil_scoped_release free;
  library().lock();
}
Alone::~Alone() { library().unlock(); }

void check_same(const Comm& comm, const std::string& name, const std::string& text) {
  const auto first = base::of_rank(comm, 0, text);
  base::collectively(comm, [&] {
    if (text == first) return;
    const auto [there, here] = first_difference(first, text);
    throw Error(fmt::format("{}: differs between ranks, must be the same on all: rank 0 has {}, rank {} has {}", name,
                            trimmed(there), comm.getRank(), trimmed(here)));
  });
}

void from_python(const Comm& comm, const std::function<void()>& work) {
  std::exception_ptr raised;
  std::string message;
  try {
    work();
  } catch (const std::exception& error) {
    raised = std::current_exception();
    message = error.what();
  }
  try {
    base::collectively(comm, [&] { SPREKK_CHECK(!raised, "rank {}: {}", comm.getRank(), message); });
  } catch (const Error&) {
    if (raised) std::rethrow_exception(raised);
    throw;
  }
}

void check_thread(const Comm& comm) {
  if (comm.getSize() == 1) return;
  static const auto first = std::this_thread::get_id();
  base::collectively(comm, [&] {
    SPREKK_CHECK(std::this_thread::get_id() == first,
                 "a model on {} ranks is used by a second thread; models on several ranks need one and the same thread",
                 comm.getSize());
  });
}

}  // namespace sprekk::python
