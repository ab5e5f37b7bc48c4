// Change of the condensed matrix by changed rows of a local group, as a matrix of low rank.
#pragma once

#include <vector>

#include "solve/elimination_plan.hpp"

namespace sprekk::solve {

/// Change of J of the only remaining block a since a reference (index 0), for constant A_aa and A_az and one local
/// group z:
///   J = J_0 - U Q,  U = A_az A_zz0^-1 E,  Q = E^T (D A_za - A_za0 - (D A_zz - A_zz0) A_zz^-1 A_za)
/// E [unknown of z, chosen row] selects rows that have changed, apart from a factor; D scales the rows to those of the
/// reference, which leaves A_zz^-1 A_za unchanged. Rows of E are numbered over all ranks, rank by rank. Members are
/// local unless stated otherwise.
class GroupChange {
 public:
  /// `group` and `problem` must outlive the object. `a`: the remaining block. Collective.
  GroupChange(const BlockProblem& problem, const GroupPlan& group, int a);

  /// Receives A_za [entity: m, columns] and, after it, A_zz^-1 A_za of an update of the elimination. A_zz is that of
  /// the group.
  void take_coupling(const View<Real*>& coupling);
  void take_response(const View<Real*>& response) { response_ = base::to_host(response); }

  /// Makes the present values the reference. No row is chosen.
  void set_reference();
  /// Marks the rows that differ from the reference. Returns whether a row has changed that is not chosen.
  bool mark_changes();
  /// Chooses all marked rows. Collective.
  void choose();
  int n_chosen() const { return first_.back(); }  ///< on all ranks
  int first() const { return first_[rank_]; }     ///< number of the first chosen row of this rank
  int n_here() const { return static_cast<int>(rows_.size()); }
  int n_marked() const;  ///< on this rank

  /// Computes Q from the present values.
  void update();
  /// Returns Q y on this rank, [chosen row here], for y [column] at the columns of map().
  std::vector<Real> product(const Real* y) const;
  /// Adds Q_i. G to row i of `result` [chosen row here, chosen row], for G [column of map(), chosen row].
  void add_product(const std::vector<Real>& G, std::vector<Real>& result) const;
  const RCP<const Map>& map() const { return map_; }  ///< unknowns of a with an entry in Q

  /// Receives A_zz^-1 b_z of a right side b [block]; then b_z = A_zz E coefficients() if b_z is zero in other rows.
  void take_solution(const BlockVector& z);
  const std::vector<Real>& coefficients() const { return coefficients_; }  ///< [chosen row here]

  /// Computes c = U s for s [chosen row here]. Collective.
  void expand(const std::vector<Real>& s, Vector& c) const;

 private:
  struct Row {
    LocalIndex entity;
    int component;
  };
  std::size_t n_columns(LocalIndex e) const { return start_[e + 1] - start_[e]; }
  template <class Visit>
  void for_terms(LocalIndex entity, int component, const Visit& visit) const;
  Real scale(LocalIndex entity, int component) const;

  const BlockProblem& problem_;
  const GroupPlan& group_;
  int a_, m_, rank_;
  std::vector<std::size_t> start_;  // [entity + 1] first column
  std::vector<LocalIndex> column_;  // [all columns] of map()
  RCP<const Map> map_;
  View<Real*>::HostMirror dense_, response_;  // present A_zz, A_zz^-1 A_za
  std::vector<Real> coupling_;                // present A_za
  std::vector<Real> unit_;                    // [m] sizes of the unknowns of z
  std::vector<Real> dense0_, coupling0_, lu0_;
  std::vector<int> pivot0_;
  std::vector<char> marked_, chosen_;  // [entity * m + component]
  std::vector<Row> rows_;              // chosen rows of this rank
  std::vector<int> first_{0, 0};       // [rank + 1]
  std::vector<Real> Q_;                // [rows: columns of the entity]
  std::vector<std::size_t> Q_start_;   // [row]
  std::vector<Real> inverse_;          // [row, m] columns of A_zz0^-1 E
  std::vector<Real> coefficients_;     // [row] of a right side
};

}  // namespace sprekk::solve
