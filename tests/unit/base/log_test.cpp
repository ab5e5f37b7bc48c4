#include "base/log.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <ctime>
#include <sstream>
#include <thread>

#include "base/timer.hpp"

namespace sprekk::base {
namespace {

std::string output(Log::Level level, bool terminal) {
  const auto comm = Tpetra::getDefaultComm();
  std::ostringstream out, warnings;
  Log log(*comm, level, out, warnings, terminal);
  log.info("step {}", 1);
  log.progress("iteration {}", 2);
  log.progress("iteration {}", 3);
  log.warning("odd");
  EXPECT_EQ(warnings.str(), comm->getRank() == 0 ? "warning: odd\n" : "");
  return out.str();
}

TEST(Log, prints_on_rank_0_and_shows_progress_on_terminals) {
  if (Tpetra::getDefaultComm()->getRank() == 0) {
    EXPECT_EQ(output(Log::Level::normal, false), "step 1\n");
    EXPECT_EQ(output(Log::Level::normal, true), "step 1\niteration 2\r\x1b[Kiteration 3\r\x1b[K");
    EXPECT_EQ(output(Log::Level::quiet, true), "");
  } else {
    EXPECT_EQ(output(Log::Level::normal, true), "");
  }
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
  EXPECT_LT(outer.cpu_seconds, 0.5 * outer.seconds);  // asleep
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
