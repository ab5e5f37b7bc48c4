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
using fields::MultiVector;
using fields::Vector;

/// Factors L U, or L D L^T for symmetric matrices. Unknowns must be numbered from 0 without gaps. All members are
/// collective and return the same on all ranks, unless they return stored data.
class Mumps {
 public:
  /// `controls`: ICNTL(i) and CNTL(i), which override the defaults. Ranks 0 to max_ranks - 1 share the factors. One
  /// rank adds in the same order every time. Throws an Error for unknown controls.
  Mumps(const Teuchos::ParameterList& controls, int max_ranks);
  ~Mumps();
  Mumps(const Mumps&) = delete;
  Mumps& operator=(const Mumps&) = delete;

  /// Factorises the present values of A, whose graph must not change. Returns an error message, or an empty string.
  /// Throws an Error if unknowns are not numbered from 0 without gaps.
  std::string factor(const RCP<const CrsMatrix>& A, bool symmetric);

  /// Computes x = A^-1 b with the accuracy of the factors, for all columns of b together. Returns an error message,
  /// also that of the last factor(), or an empty string.
  std::string substitute(const MultiVector& b, MultiVector& x);

  /// Return the floating-point operations of the last factor() and of a substitute(), and the entries of the factors.
  /// Stored data, equal on all ranks.
  Real operations() const { return size_[0]; }
  Real operations_of_substitution() const { return (symmetric_ ? 4 : 2) * entries(); }
  Real entries() const { return size_[1]; }

  /// Returns all controls that differ from the defaults of MUMPS. Stored data.
  const Teuchos::ParameterList& parameters() const { return parameters_; }

 private:
  int run(int job);
  MPI_Comm all_ranks() const;
  RCP<const CrsMatrix> places_on_root();
  void start(bool symmetric);
  void read_controls();
  void fill_values();
  void count_operations();
  void release();

  Teuchos::ParameterList parameters_;
  const int max_ranks_;  // ranks that share the factors
  RCP<const Comm> comm_;
  std::map<int, int> icntl_;    // by i - 1
  std::map<int, double> cntl_;  // by i - 1
  DMUMPS_STRUC_C mumps_{};
  MPI_Comm mpi_comm_ = MPI_COMM_NULL;
  bool ready_ = false, analysed_ = false, symmetric_ = false;
  bool gathers_ = false;   // rank 0 receives the whole matrix
  Real size_[2] = {0, 0};  // of the last factor(): operations, entries
  std::string failure_ = "the matrix was not set up";
  RCP<const CrsMatrix> matrix_;
  std::vector<int> counts_, starts_;    // [rank] number and start of values
  std::vector<Real> gathered_;          // values of all ranks
  std::vector<int> rows_, columns_;     // 1-based
  std::vector<std::size_t> positions_;  // indices of the values passed to MUMPS; empty: all
  std::vector<double> values_;          // values of these entries
  RCP<fields::Import> to_root_, from_root_;
  RCP<MultiVector> at_root_;  // whole vectors on rank 0
};

}  // namespace sprekk::multigrid
