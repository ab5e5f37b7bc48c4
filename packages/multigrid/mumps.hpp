// Factors of a sparse matrix by MUMPS, through its C interface.
#pragma once

#include <dmumps_c.h>

#include <Teuchos_ParameterList.hpp>

#include <map>
#include <string>
#include <vector>

#include "fields/types.hpp"

namespace sprekk::multigrid {

using fields::CrsMatrix;
using fields::Vector;

/// L U of a matrix, or L D L^T of a symmetric one; unknowns are numbered from 0 without gaps. All members are
/// collective and answer the same on every rank, unless they return stored data.
class Mumps {
 public:
  /// `controls`: ICNTL(i) and CNTL(i), over the defaults. Ranks 0 to most_ranks - 1 share the factors; one alone adds
  /// in the same order every time. Throws where MUMPS has no such control.
  Mumps(const Teuchos::ParameterList& controls, int most_ranks);
  ~Mumps();
  Mumps(const Mumps&) = delete;
  Mumps& operator=(const Mumps&) = delete;

  /// Factors the present values of A, whose graph must stay that of the first. Empty, or what failed.
  std::string factor(const RCP<const CrsMatrix>& A, bool symmetric);

  /// x <- A^-1 b by the factors, as exact as these. Empty, or what failed, now or in the last factor().
  std::string substitute(const Vector& b, Vector& x);

  /// All controls that differ from those of MUMPS itself. Stored data.
  const Teuchos::ParameterList& parameters() const { return parameters_; }

 private:
  int run(int job);
  MPI_Comm all_ranks() const;
  RCP<const CrsMatrix> places_on_root();
  void start(bool symmetric);
  void read_controls();
  void fill_values();
  void release();

  Teuchos::ParameterList parameters_;
  const int most_ranks_;  // that share the factors
  RCP<const Comm> comm_;
  std::map<int, int> icntl_;    // from 0
  std::map<int, double> cntl_;  // from 0
  DMUMPS_STRUC_C mumps_{};
  MPI_Comm mpi_comm_ = MPI_COMM_NULL;
  bool ready_ = false, analysed_ = false, symmetric_ = false;
  bool gathers_ = false;  // rank 0 gets all of the matrix
  std::string failure_ = "the matrix was not set up";
  RCP<const CrsMatrix> matrix_;
  std::vector<int> counts_, starts_;    // of the ranks' values
  std::vector<Real> gathered_;          // those of all ranks
  std::vector<int> rows_, columns_;     // 1-based
  std::vector<std::size_t> positions_;  // of the entries handed over, in the matrix' or all ranks' values; none: all
  std::vector<double> values_;          // of these
  RCP<fields::Import> to_root_, from_root_;
  RCP<Vector> at_root_;  // all of a vector on rank 0
};

}  // namespace sprekk::multigrid
