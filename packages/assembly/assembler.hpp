// Generic kernel of all modules: gathers the unknowns of an entity, calls the local operator, scatters the result.
#pragma once

#include "assembly/module.hpp"
#include "assembly/slots.hpp"

#include <utility>

namespace sprekk::assembly {

/// Applies a local operator to all entities of a loop. Op is copied into kernels. Its members:
///   using Columns = Slots<...>, Rows = Slots<...>;                 unknowns read, rows written, in local order
///   void residual(int e, const Real (&x)[Columns::size], Real (&r)[Rows::size]) const;
///     device code, overwrites r
///   void jacobian(int e, const Real (&x)[Columns::size], Real (&J)[Rows::size][Columns::size]) const;
///     device code, overwrites J
///   static constexpr bool couples(int row_slot, int column_slot);  optional; false: J is zero there and is not added
template <class Op>
class Assembler {
 public:
  using Columns = typename Op::Columns;
  using OpRows = typename Op::Rows;
  enum class Positions { keep, once };  ///< keep: save scatter positions for the next assembly; once: discard them

  /// row_fields, column_fields: block numbers in the order of the operator's slots.
  Assembler(const Context& context, Loop loop, std::vector<int> row_fields, std::vector<int> column_fields,
            Positions positions)
      : row_fields_(std::move(row_fields)),
        column_fields_(std::move(column_fields)),
        keep_(positions == Positions::keep) {
    for (int f : row_fields_) {
      rows_.push_back(context.stencil(loop, f));
      n_owned_.push_back(context.layout(f).n_owned());
    }
    for (int f : column_fields_) columns_.push_back(context.stencil(loop, f));
    n_entities_ = static_cast<LocalIndex>(columns_.front().first.extent(0));
  }

  LocalIndex n_entities() const { return n_entities_; }

  template <class T>
  using PerColumn = Kokkos::Array<T, Columns::n>;

  /// Copies the unknowns of an entity into one local array. Absent unknowns are zero.
  struct Gather {
    Op op;
    PerColumn<ConstView<LocalIndex**>> first;  // [entity, group]
    PerColumn<ConstView<Real*>> x;             // [unknown]

    KOKKOS_INLINE_FUNCTION void operator()(int e, Real (&local)[Columns::size]) const {
      for (int k = 0; k < Columns::n; ++k)
        for (int g = 0; g < Columns::count(k); ++g)
          for (int c = 0; c < Columns::width(k); ++c)
            local[Columns::offset(k) + g * Columns::width(k) + c] = first[k](e, g) < 0 ? 0 : x[k](first[k](e, g) + c);
    }
  };

  /// Adds op.residual of all entities to r[row field]. Writes owned rows only. Local.
  void add_residual(const Op& op, const State& state, const Rows& r) const {
    ResidualKernel kernel{gather(op, state), {}, {}, {}};
    for (int i = 0; i < OpRows::n; ++i) {
      kernel.first[i] = rows_[i].first;
      kernel.r[i] = r[row_fields_[i]];
      kernel.n_owned[i] = n_owned_[i];
    }
    Kokkos::parallel_for("residual", Kokkos::RangePolicy<Execution>(0, n_entities_), kernel);
  }

  /// Calls visit(entity, unknowns) for each entity of the loop. visit is device code. Local.
  template <class Visit>
  void for_each(const Op& op, const State& state, const Visit& visit) const {
    const Gather gathered = gather(op, state);
    Kokkos::parallel_for(
        "for each", Kokkos::RangePolicy<Execution>(0, n_entities_), KOKKOS_LAMBDA(int e) {
          Real x[Columns::size];
          gathered(e, x);
          visit(e, x);
        });
  }

  /// Adds op.jacobian of all entities to the blocks J(row field, column field). Writes owned rows only and skips absent
  /// blocks. Local.
  void add_jacobian(const Op& op, const State& state, fields::BlockMatrix& J) {
    JacobianKernel kernel{gather(op, state), {}, {}, {}, {}, {}};
    if (positions_.empty()) find_all_positions(J);
    for (int i = 0; i < OpRows::n; ++i) {
      kernel.first[i] = rows_[i].first;
      kernel.n_owned[i] = n_owned_[i];
      for (int k = 0; k < Columns::n; ++k) {
        const auto& block = J(row_fields_[i], column_fields_[k]);
        if (block.is_null() || !couples(i, k)) continue;
        const auto local = block->getLocalMatrixDevice();
        kernel.row_begin[i][k] = local.graph.row_map;
        kernel.values[i][k] = local.values;
        kernel.positions[i][k] = positions_[i * Columns::n + k];
      }
    }
    Kokkos::parallel_for("jacobian", Kokkos::RangePolicy<Execution>(0, n_entities_), kernel);
    if (!keep_) positions_.clear();
  }

 private:
  template <class T>
  static constexpr auto couples_in(int i, int k, int) -> decltype(T::couples(i, k)) {
    return T::couples(i, k);
  }
  template <class T>
  static constexpr bool couples_in(int, int, long) {
    return true;
  }
  static constexpr bool couples(int i, int k) { return couples_in<Op>(i, k, 0); }

  using LocalMatrix = fields::CrsMatrix::local_matrix_device_type;
  template <class T>
  using PerRow = Kokkos::Array<T, OpRows::n>;

  struct ResidualKernel {
    Gather gather;
    PerRow<ConstView<LocalIndex**>> first;  // [entity, group]
    PerRow<View<Real*>> r;                  // [owned row]
    PerRow<LocalIndex> n_owned;

    KOKKOS_INLINE_FUNCTION void operator()(int e) const {
      Real x[Columns::size], local[OpRows::size];
      gather(e, x);
      gather.op.residual(e, x, local);
      for (int i = 0; i < OpRows::n; ++i)
        for (int g = 0; g < OpRows::count(i); ++g) {
          const LocalIndex row = first[i](e, g);
          if (row < 0 || row >= n_owned[i]) continue;  // absent, or row of another rank
          for (int c = 0; c < OpRows::width(i); ++c)
            Kokkos::atomic_add(&r[i](row + c), local[OpRows::offset(i) + g * OpRows::width(i) + c]);
        }
    }
  };

  struct JacobianKernel {
    Gather gather;
    PerRow<ConstView<LocalIndex**>> first;                            // [entity, group]
    PerRow<PerColumn<ConstView<LocalIndex***>>> positions;            // [entity, row group, column group]
    PerRow<PerColumn<typename LocalMatrix::row_map_type>> row_begin;  // [row]
    PerRow<PerColumn<typename LocalMatrix::values_type>> values;      // [entry]
    PerRow<LocalIndex> n_owned;

    KOKKOS_INLINE_FUNCTION void operator()(int e) const {
      Real x[Columns::size], local[OpRows::size][Columns::size];
      gather(e, x);
      gather.op.jacobian(e, x, local);
      scatter(e, local, std::make_integer_sequence<int, OpRows::n * Columns::n>());
    }

    template <int... block>
    KOKKOS_INLINE_FUNCTION void scatter(int e, const Real (&local)[OpRows::size][Columns::size],
                                        std::integer_sequence<int, block...>) const {
      (add<block / Columns::n, block % Columns::n>(e, local), ...);
    }

    template <int i, int k>
    KOKKOS_INLINE_FUNCTION void add(int e, const Real (&local)[OpRows::size][Columns::size]) const {
      constexpr int height = OpRows::width(i), width = Columns::width(k);
      if (values[i][k].extent(0) == 0) return;
      for (int g = 0; g < OpRows::count(i); ++g) {
        const LocalIndex row = first[i](e, g);
        if (row < 0 || row >= n_owned[i]) continue;  // absent, or row of another rank
        std::size_t begin[height];
        for (int c = 0; c < height; ++c) begin[c] = row_begin[i][k](row + c);
        for (int h = 0; h < Columns::count(k); ++h) {
          const LocalIndex position = positions[i][k](e, g, h);
          if (position < 0) continue;  // the column is absent
          for (int c = 0; c < height; ++c)
            for (int d = 0; d < width; ++d)
              Kokkos::atomic_add(&values[i][k](begin[c] + position + d),
                                 local[OpRows::offset(i) + g * height + c][Columns::offset(k) + h * width + d]);
        }
      }
    }
  };

  Gather gather(const Op& op, const State& state) const {
    Gather g{op, {}, {}};
    for (int k = 0; k < Columns::n; ++k) {
      g.first[k] = columns_[k].first;
      g.x[k] = state.x[column_fields_[k]];
    }
    return g;
  }

  void find_all_positions(const fields::BlockMatrix& J) {
    for (int i = 0; i < OpRows::n; ++i)
      for (int k = 0; k < Columns::n; ++k) {
        const auto& block = J(row_fields_[i], column_fields_[k]);
        positions_.push_back(block.is_null() || !couples(i, k) ? ConstView<LocalIndex***>()
                                                               : find_positions(*block, rows_[i], columns_[k]));
      }
  }

  std::vector<int> row_fields_, column_fields_;
  std::vector<Stencil> rows_, columns_;
  std::vector<LocalIndex> n_owned_;
  std::vector<ConstView<LocalIndex***>> positions_;
  LocalIndex n_entities_ = 0;
  bool keep_;
};

}  // namespace sprekk::assembly
