// Reuse of a preconditioner: kept, rejected, set up again.
#include "solve/reuse.hpp"

#include <gtest/gtest.h>

namespace sprekk::test {
namespace {

using solve::Reuse;
using State = Reuse::State;

TEST(Reuse, KeepsWhatServesAndRenewsWhatIsWorn) {
  Reuse reuse;
  EXPECT_FALSE(reuse.may_keep());
  reuse.make(true);
  EXPECT_EQ(reuse.max_iterations(1e-8), 0);
  reuse.learn(16, 1e-8, 1e-8);  // two iterations per digit
  ASSERT_TRUE(reuse.may_keep());
  reuse.keep();
  EXPECT_EQ(reuse.max_iterations(1e-4), 8 + Reuse::max_more);
  EXPECT_FALSE(reuse.gives_up(9, true));
  reuse.learn(9, 1e-4, 1e-4);
  EXPECT_EQ(reuse.state(), State::reused);
  reuse.learn(11, 1e-4, 1e-4);
  EXPECT_EQ(reuse.state(), State::worn);
  EXPECT_TRUE(reuse.is_of_earlier_system());
  EXPECT_FALSE(reuse.may_keep());
  reuse.learn(8, 1e-4, 1e-4);  // for another right-hand side
  EXPECT_TRUE(reuse.may_keep());
  EXPECT_TRUE(reuse.gives_up(12, false));
  EXPECT_FALSE(reuse.is_careful());  // it was only too old
}

TEST(Reuse, IsCarefulOnceASolveWithUntriedCyclesIsLong) {
  Reuse reuse;
  reuse.make(false);
  EXPECT_EQ(reuse.max_iterations(1e-8), Reuse::max_unchecked);
  EXPECT_FALSE(reuse.gives_up(Reuse::max_unchecked - 1, false));  // the library stopped before the limit
  EXPECT_FALSE(reuse.gives_up(Reuse::max_unchecked, true));
  EXPECT_FALSE(reuse.is_careful());
  EXPECT_TRUE(reuse.gives_up(Reuse::max_unchecked, false));
  EXPECT_TRUE(reuse.is_careful());
  reuse.make(true);
  EXPECT_FALSE(reuse.gives_up(1000, false));  // no better preconditioner is available
}

TEST(Reuse, LearnsNothingFromSolvesThatGainLessThanADigit) {
  Reuse reuse;
  reuse.make(true);
  reuse.learn(20, 1e-10, 1e-10);
  reuse.learn(7, 0.5, 1e-10);
  reuse.keep();
  EXPECT_EQ(reuse.max_iterations(1e-10), 20 + Reuse::max_more);
  reuse.lose();
  EXPECT_FALSE(reuse.may_keep());
}

}  // namespace
}  // namespace sprekk::test
