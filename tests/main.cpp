// GoogleTest under MPI: every rank runs every test, rank 0 reports, and a failure on any rank fails the program.
#include <gtest/gtest.h>

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Core.hpp>

#include <iostream>

#include "source_dir.hpp"

std::string sprekk::tests::source_dir() { return SPREKK_SOURCE_DIR; }

int main(int argc, char** argv) {
  Tpetra::ScopeGuard guard(&argc, &argv);
  testing::InitGoogleTest(&argc, argv);
  int failed = 0;
  {
    const auto comm = Tpetra::getDefaultComm();
    auto& listeners = testing::UnitTest::GetInstance()->listeners();
    if (comm->getRank() != 0) delete listeners.Release(listeners.default_result_printer());
    const int failed_here = RUN_ALL_TESTS() != 0 ? 1 : 0;
    if (failed_here && comm->getRank() != 0) {
      const auto* unit = testing::UnitTest::GetInstance();
      for (int s = 0; s < unit->total_test_suite_count(); ++s)
        for (int t = 0; t < unit->GetTestSuite(s)->total_test_count(); ++t) {
          const auto* info = unit->GetTestSuite(s)->GetTestInfo(t);
          for (int p = 0; p < info->result()->total_part_count(); ++p)
            if (info->result()->GetTestPartResult(p).failed())
              std::cerr << "rank " << comm->getRank() << ": " << info->test_suite_name() << "." << info->name() << ": "
                        << info->result()->GetTestPartResult(p).summary() << std::endl;
        }
    }
    Teuchos::reduceAll(*comm, Teuchos::REDUCE_MAX, 1, &failed_here, &failed);
  }
  return failed;
}
