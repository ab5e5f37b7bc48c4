// From one level of multigrid to the next: interpolation by smoothed aggregation, and the coarse matrix.
#pragma once

#include "solve/aggregates.hpp"
#include "solve/slices.hpp"

namespace sprekk::solve {

/// P = (I - w D^-1 A) T, R = T^T (I - w A D^-1) and R A P of a matrix A whose values change and whose graph does not,
/// with T the tentative prolongator of aggregates and D the diagonal of A (Vanek, Mandel and Brezina 1996; R of a
/// matrix that is not symmetric is P^T of its transpose: Sala and Tuminaro 2008). In P and R, blocks of A between nodes
/// out of each other's reach are added to the diagonal, or levels would fill up where cells are flat. Where numbers go
/// is found once, with the graphs; of A P there is never more than a slice. P and R are
/// stored in single precision, and R A P is the product of what is stored. Coarse nodes are aggregates, numbered
/// through the ranks; their unknowns are modes. R has the graph of P^T.
class Galerkin {
 public:
  /// Makes the graphs. `tentative` [owned node, unknown, mode]. Throws where a node couples to 32767 others or more.
  /// Collective.
  Galerkin(const NodeMatrix& A, const Nodes& nodes, const Aggregates& aggregates, const std::vector<Real>& tentative);

  /// Makes the matrices for the present values of A; `inverse_diagonal` [all nodes, unknown] is w D^-1. Collective.
  void update(const NodeMatrix& A, const View<Real*>& inverse_diagonal, bool symmetric);

  const ShortNodeMatrix& prolongation() const { return P_; }  ///< [fine, coarse]
  const ShortNodeMatrix& restriction() const { return R_; }   ///< [coarse, fine]
  const NodeMatrix& coarse() const { return coarse_; }
  std::size_t bytes() const;  ///< of values and places of products

 private:
  using Slot = std::uint16_t;  // a place in a row; in slot_P_ and slot_R_ perhaps marked as out of reach

  /// Places in rows of at most so many entries, in one byte each if that will do.
  class Slots {
   public:
    Slots() = default;
    Slots(std::size_t n, std::size_t longest_row)
        : narrow_("slots", longest_row <= 256 ? n : 0), wide_("slots", longest_row <= 256 ? 0 : n) {}
    KOKKOS_FORCEINLINE_FUNCTION std::size_t operator()(std::size_t k) const {
      return wide_.extent(0) == 0 ? narrow_(k) : wide_(k);
    }
    void set(std::size_t k, Slot slot) const {
      if (wide_.extent(0) == 0)
        narrow_(k) = static_cast<std::uint8_t>(slot);
      else
        wide_(k) = slot;
    }
    std::size_t bytes() const { return narrow_.extent(0) + sizeof(Slot) * wide_.extent(0); }

   private:
    View<std::uint8_t*> narrow_;
    View<Slot*> wide_;
  };

  void find_members(const Aggregates& aggregates);
  void find_slots_of_fine_rows(const std::vector<bool>& far, const View<LocalIndex*>& aggregate,
                               const View<LocalIndex*>& column_AP);
  void find_slots_of_coarse_rows(const std::vector<bool>& far, const View<LocalIndex*>& aggregate,
                                 const View<LocalIndex*>& column_AP);
  void smooth(const NodeMatrix& A, const View<Real*>& inverse_diagonal) const;
  void restrict_symmetric() const;
  void restrict_general(const NodeMatrix& A, const View<Real*>& inverse_diagonal) const;
  void multiply_right(const NodeMatrix& A, const View<Real*>& AP, std::size_t first_made, std::size_t end_made) const;
  void multiply_left(const View<Real*>& AP, LocalIndex first, LocalIndex end) const;

  NodeGraph fine_;                  // of A
  View<float*> tentative_;          // [all nodes, unknown, mode]
  View<std::size_t*> start_P_all_;  // of rows of P, ghosts' included; their values follow the owned ones'
  View<LocalIndex*> column_P_all_;
  View<float*> value_P_all_;
  View<std::size_t*> start_AP_all_;   // the same of A P, of which there are slices only
  View<Slot*> slot_P_;                // [entry of A] where its column's aggregate is in the row of P
  Slots slot_AP_;                     // [owned row, entry of A, entry of P] where the product goes in the row of A P
  View<std::size_t*> first_slot_AP_;  // [owned row]
  Slots slot_transposed_;             // [entry of R] where the entry is in the row of P
  View<Slot*> slot_R_;                // [entry of A] where its column is in the row of R of its row's aggregate
  Slots slot_coarse_;                 // [coarse row, entry of R, entry of A P] where the product goes
  View<std::size_t*> first_slot_coarse_;  // [coarse row]
  View<std::size_t*> first_member_;       // [coarse row]
  View<LocalIndex*> member_;
  Slices slices_;  // of A P
  ShortNodeMatrix P_, R_;
  NodeMatrix coarse_;
};

}  // namespace sprekk::solve
