// Energy of a system, and the work of its loads, fields and modules.
#pragma once

#include "assembly/structure.hpp"

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace sprekk::assembly {

/// Sums of work since the start, J (2D: J/m), by their path in results.json.
///
/// Fields of motion are those with the scales of the field with rigid motions. Their rows r are forces, linear in the
/// unknowns: r = K u + sum_b B_b x_b - f with the fields of motion u and other fields x_b. In a step, with the mean F
/// of the forces at its begin and end and the increment du:
///   elastic                         u . K u/2, a state, not a sum
///   work > loads, FIELD, supports   f . du, -B_b x_b . du, and r . du of the prescribed unknowns
///   released                        -h . du of the forces h that held new faces when the mesh or the rock changed, and
///                                   the decrease of u . K u/2 by the change itself
///   unassigned                      elastic minus its value at the start, plus released, minus the sum of the work
/// The last one is the work of the residual. h is the residual at the continued state without its prescribed unknowns;
/// it decreases to zero in the next step. At the first start it is a part of the loads instead: forces that are not
/// balanced act gradually in the first step.
///
/// Rows of balances with unknowns in Pa are volume rates. The work of a module in a step is
///   balance > MODULE                -dt p . (its part of the rows at the end of the step); name up to a comma
/// positive for injection, negative for dissipation and storage. `supports` contains the prescribed unknowns.
class Energy {
 public:
  using Sums = std::map<std::vector<std::string>, Real>;
  /// Computes the residual without constraints at x.
  using Residual = std::function<void(const fields::BlockVector& x, fields::BlockVector& r)>;

  Energy(const Structure& structure, Residual residual);

  /// Starts at x if there are no sums, else continues with them. Collective.
  void start(const fields::BlockVector& x, Sums sums);
  /// Adds the work of a step of length dt to x. `state`: at x, with the histories before the commit. Collective.
  void commit(const fields::BlockVector& x, Real dt, const State& state);
  /// Sums of the committed steps and the elastic energy, the same on all ranks. Stored data.
  const Sums& sums() const { return sums_; }

 private:
  /// Forces of a part of the equations on the fields of motion, [field of motion].
  struct Part {
    std::vector<std::string> path;
    std::vector<int> fields;  ///< blocks on which it depends; empty: loads, and forces that held new faces
    fields::BlockVector force = {};
  };
  void set_forces(const fields::BlockVector& x);
  Real elastic() const;
  Real work(const fields::BlockVector& old, const fields::BlockVector& now, const fields::BlockVector& dx,
            bool prescribed_only) const;
  void add_balances(const fields::BlockVector& x, Real dt, const State& state, Sums& sums) const;

  const Structure& structure_;
  Residual residual_;
  std::vector<int> motion_, balances_;  // blocks
  std::vector<Part> parts_;             // fields of motion themselves, released, each other field, loads
  fields::BlockVector x_, total_;       // [field of motion] at the last commit; total_: all forces
  Sums sums_;
};

}  // namespace sprekk::assembly
