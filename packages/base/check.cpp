#include "base/check.hpp"

#include <filesystem>
#include <new>

#include "base/memory.hpp"
#include "base/over_ranks.hpp"

namespace sprekk::base {

void collectively(const Comm& comm, const std::function<void()>& work) {
  std::string message;
  int failing_rank = comm.getSize();
  try {
    work();
  } catch (const std::filesystem::filesystem_error& error) {
    message = fmt::format("{}: {}", error.path1().string(), error.code().message());
    failing_rank = comm.getRank();
  } catch (const std::bad_alloc&) {
    message = out_of_memory();
    failing_rank = comm.getRank();
  } catch (const std::exception& error) {
    message = error.what();
    failing_rank = comm.getRank();
  }
  const int first = min_over_ranks(comm, failing_rank);
  if (first == comm.getSize()) return;
  throw Error(of_rank(comm, first, message));
}

}  // namespace sprekk::base
