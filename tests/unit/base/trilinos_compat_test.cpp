#include "base/trilinos_compat.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <Tpetra_Map.hpp>
#include <vector>

namespace sprekk {
namespace {

/// Interface of maps and matrices in Trilinos 16, which the tests cannot link.
struct Later {
  std::size_t getLocalNumElements() const { return 3; }
  std::vector<int> getLocalElementList() const { return {7, 8, 9}; }
  std::size_t getLocalNumRows() const { return 4; }
  std::size_t getLocalNumCols() const { return 5; }
  std::size_t getLocalNumEntries() const { return 6; }
};

/// Interface of intermediate versions: both names exist, the old ones are deprecated.
struct Both : Later {
  [[deprecated]] std::size_t getNodeNumElements() const { return 0; }
};

TEST(TrilinosCompat, TakesTheNamesOfLaterVersions) {
  const Later later;
  EXPECT_EQ(base::n_local_elements(later), 3u);
  EXPECT_EQ(base::local_elements(later), (std::vector<int>{7, 8, 9}));
  EXPECT_EQ(base::n_local_rows(later), 4u);
  EXPECT_EQ(base::n_local_columns(later), 5u);
  EXPECT_EQ(base::n_local_entries(later), 6u);
  EXPECT_EQ(base::n_local_elements(Both()), 3u);
}

TEST(TrilinosCompat, TakesTheInstalledOnes) {
  const auto comm = Tpetra::getDefaultComm();
  const Tpetra::Map<> map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(), 2 + comm->getRank(), 0, comm);
  EXPECT_EQ(base::n_local_elements(map), 2u + comm->getRank());
  EXPECT_EQ(base::local_elements(map).front(), map.getGlobalElement(0));
}

}  // namespace
}  // namespace sprekk
