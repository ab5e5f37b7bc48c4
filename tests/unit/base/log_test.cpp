#include "base/log.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <sstream>
#include <thread>

#include "base/check.hpp"
#include "base/timer.hpp"

namespace sprekk::base {
namespace {

std::string content(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Logs a line before the file is open, then a warning and an error.
void add_lines(const std::string& path, bool append) {
  const auto comm = Tpetra::getDefaultComm();
  std::ostringstream out, warnings;
  Log log(*comm, append ? nullptr : &out, warnings);
  log.info("step {}", 1);
  log.open(path, append);
  log.warning("odd");
  log.error("broken");
  const bool writes = comm->getRank() == 0;
  EXPECT_EQ(out.str(), writes && !append ? "step 1\n" : "");
  EXPECT_EQ(warnings.str(), writes ? "warning: odd\n" : "");
}

TEST(Log, writes_streams_and_a_file_on_rank_0) {
  const auto comm = Tpetra::getDefaultComm();
  const std::string lines = "step 1\nwarning: odd\nerror: broken\n";
  const auto path = fmt::format("log_test_{}.txt", comm->getSize());  // tests with other numbers of ranks run at the
                                                                      // same time
  add_lines(path, false);
  add_lines(path, false);
  if (comm->getRank() == 0) EXPECT_EQ(content(path), lines);
  add_lines(path, true);
  if (comm->getRank() == 0) {
    EXPECT_EQ(content(path), lines + lines);
    std::remove(path.c_str());
  }
}

TEST(Log, a_line_that_cannot_be_written_is_an_error_on_every_rank) {
  std::ostringstream out;
  Log log(*Tpetra::getDefaultComm(), nullptr, out);
  log.open("/dev/full", true);
  EXPECT_NO_THROW(log.check_file());
  log.info("step 1");
  log.info("step 2");
  EXPECT_THROW(log.check_file(), Error);
}

TEST(Timers, add_up_phases_in_the_order_of_their_first_use) {
  Timers timers;
  for (int i = 0; i < 3; ++i) {
    const auto outer = timers.scope("outer");
    const auto inner = timers.scope("inner");
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  { const auto last = timers.scope("last"); }
  ASSERT_EQ(timers.phases().size(), 3u);
  const auto &outer = timers.phases()[0], &inner = timers.phases()[1], &last = timers.phases()[2];
  EXPECT_EQ(outer.name, "outer");
  EXPECT_EQ(inner.name, "inner");
  EXPECT_EQ(outer.count, 3);
  EXPECT_EQ(last.count, 1);
  EXPECT_GE(inner.seconds, 0.015);
  EXPECT_GE(outer.seconds, inner.seconds);
  EXPECT_GE(last.seconds, 0);
  EXPECT_LT(outer.cpu_seconds, 0.5 * outer.seconds);  // the thread sleeps
}

TEST(Timers, count_what_the_process_works) {
  Timers timers;
  const auto begin = std::clock();
  {
    const auto work = timers.scope("work");
    while (std::clock() - begin < CLOCKS_PER_SEC / 50) {
    }
  }
  EXPECT_GE(timers.phases()[0].cpu_seconds, 0.019);
  EXPECT_LT(timers.phases()[0].cpu_seconds, 1);
}

TEST(Memory, peak_grows_with_what_is_touched) {
  const auto before = peak_memory_bytes();
  const std::vector<char> block(before + (std::size_t(64) << 20), 1);
  EXPECT_GE(peak_memory_bytes(), block.size());
  EXPECT_GT(before, std::size_t(1) << 20);
}

}  // namespace
}  // namespace sprekk::base
