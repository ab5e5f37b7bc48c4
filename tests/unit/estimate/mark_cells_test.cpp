#include "estimate/goals.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace sprekk::estimate {
namespace {

/// Values 2, 4, 8, ... and 0: the largest contains half of the sum, the two largest 0.7. Equal values are marked
/// together.
TEST(MarkCells, MarksTheFewestCells) {
  const auto comm = Tpetra::getDefaultComm();
  std::vector<Real> here;
  for (int k = comm->getRank(); k < 12; k += comm->getSize()) here.push_back(k == 0 ? 0 : std::exp2(k) * 1e-7);
  const auto n_marked = [&](const std::vector<Real>& values, Real theta) {
    int mine = 0, all = 0;
    for (const LocalIndex c : mark_cells(*comm, values, theta)) {
      EXPECT_GE(values[c], 1e-7 * std::exp2(theta < 0.6 ? 11 : 10));
      ++mine;
    }
    Teuchos::reduceAll(*comm, Teuchos::REDUCE_SUM, 1, &mine, &all);
    return all;
  };
  EXPECT_EQ(n_marked(here, 0.5), 1);
  EXPECT_EQ(n_marked(here, 0.7), 2);
  EXPECT_EQ(n_marked(std::vector<Real>(5, 1), 0.1), 5 * comm->getSize());
  EXPECT_EQ(n_marked(std::vector<Real>(5, 0), 0.5), 0);
}

}  // namespace
}  // namespace sprekk::estimate
