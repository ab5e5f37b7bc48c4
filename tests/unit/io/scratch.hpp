// Temporary directory for one test.
#pragma once

#include "base/types.hpp"

#include <gtest/gtest.h>
#include <Teuchos_CommHelpers.hpp>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <unistd.h>

namespace sprekk::test {

/// Directory created by rank 0 and removed by the destructor; its path is equal on all ranks. Construction and
/// destruction are collective.
class Scratch {
 public:
  explicit Scratch(const Comm& comm) : comm_(comm) {
    int id = static_cast<int>(::getpid());
    Teuchos::broadcast(comm, 0, 1, &id);
    path_ = std::filesystem::temp_directory_path() / ("sprekk_test_" + std::to_string(id));
    if (comm.getRank() == 0) std::filesystem::create_directories(path_);
    comm.barrier();
  }
  ~Scratch() {
    comm_.barrier();
    if (comm_.getRank() == 0) std::filesystem::remove_all(path_);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  std::string operator/(const std::string& name) const { return path_ / name; }

  /// Runs `work` on rank 0 while the other ranks wait. Collective.
  template <class Work>
  void on_rank_0(Work work) const {
    if (comm_.getRank() == 0) work();
    comm_.barrier();
  }

 private:
  const Comm& comm_;
  std::filesystem::path path_;
};

inline std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns the message of the Error that `work` throws; the test fails if there is none.
template <class ErrorType, class Work>
std::string error_of(Work work) {
  try {
    work();
  } catch (const ErrorType& error) {
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace sprekk::test
