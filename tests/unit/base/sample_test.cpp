#include "base/sample.hpp"

#include <gtest/gtest.h>

namespace sprekk {
namespace {

using List = std::vector<int>;

TEST(Sample, HasTheLastElementAndEqualIntervals) {
  EXPECT_EQ(base::sample_of(List{1, 2, 3, 4, 5, 6, 7}, 3), (List{1, 4, 7}));
  EXPECT_EQ(base::sample_of(List{1, 2, 3, 4, 5, 6, 7, 8}, 3), (List{2, 5, 8}));
}

TEST(Sample, OfAFewElementsIsTheList) {
  EXPECT_EQ(base::sample_of(List{1, 2}, 3), (List{1, 2}));
  EXPECT_EQ(base::sample_of(List{}, 3), List{});
}

}  // namespace
}  // namespace sprekk
