#include "assembly/volume_work.hpp"

namespace sprekk::assembly {

namespace {

/// | symbol    | shape                | unit  |                                                |
/// | x         | vectors [m], p       | m, Pa | unknowns                                       |
/// | r         | forces [m], dV/dt    | N, m^3/s (2D: m^2/s) | -(p - p_0) dV/du, rate V        |
/// | volume    | [entity, m]          | m^2   | dV/du                                          |
/// | reference | [entity]             | Pa    | p_0; empty: zero                               |
/// | rate      |                      | 1/s   | of State, or a constant              |
template <class Vectors>
struct VolumeWork {
  using Columns = Slots<Vectors, Slot<1, 1>>;
  using Rows = Columns;
  static constexpr int m = Columns::size - 1;
  static constexpr bool couples(int row, int column) { return row != column; }
  View<Real**> volume;
  ConstView<Real*> reference;
  Real rate;

  KOKKOS_INLINE_FUNCTION void residual(int e, const Real (&x)[m + 1], Real (&r)[m + 1]) const {
    const Real p = x[m] - (reference.extent(0) > 0 ? reference(e) : 0);
    r[m] = 0;
    for (int k = 0; k < m; ++k) {
      r[k] = -volume(e, k) * p;
      r[m] += rate * volume(e, k) * x[k];
    }
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int e, const Real (&)[m + 1], Real (&J)[m + 1][m + 1]) const {
    for (auto& row : J)
      for (Real& value : row) value = 0;
    for (int k = 0; k < m; ++k) {
      J[k][m] = -volume(e, k);
      J[m][k] = rate * volume(e, k);
    }
  }
};

/// | symbol    | shape       | unit |                        |
/// | x         | 1           | Pa   | p                      |
/// | r         | [m]         | N    | -(p - p_0) dV/du       |
/// | volume    | [entity, m] | m^2  | dV/du                  |
/// | reference | [entity]    | Pa   | p_0; empty: zero       |
template <class Vectors>
struct VolumeLoad {
  using Columns = Slots<Slot<1, 1>>;
  using Rows = Slots<Vectors>;
  static constexpr int m = Rows::size;
  View<Real**> volume;
  ConstView<Real*> reference;

  KOKKOS_INLINE_FUNCTION void residual(int e, const Real (&x)[1], Real (&r)[m]) const {
    const Real p = x[0] - (reference.extent(0) > 0 ? reference(e) : 0);
    for (int k = 0; k < m; ++k) r[k] = -volume(e, k) * p;
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int e, const Real (&)[1], Real (&J)[m][1]) const {
    for (int k = 0; k < m; ++k) J[k][0] = -volume(e, k);
  }
};

/// Calls use(slot) with the slot of the vectors of an entity: the nodes of a cell, or the bubble of a side.
template <class Use>
Term with_slot(const Context& context, int block, const Use& use) {
  const auto shape = context.mesh()->shape;
  if (context.layout(block).field().entity == fields::Entity::fracture_face)
    return mesh::dimension(shape) == 2 ? use(Slot<1, 2>()) : use(Slot<1, 3>());
  return mesh::for_shape(shape, [&](auto s) { return use(Slot<mesh::n_nodes(s()), mesh::dimension(s())>()); });
}

}  // namespace

Term make_volume_work(const Context& context, const VolumeCoupling& of, bool keep, std::optional<Real> rate) {
  return with_slot(context, of.u, [&](auto slot) {
    const VolumeWork<decltype(slot)> op{of.volume, of.reference, 0};
    return Term(context, of.loop, {of.u, of.p}, {of.u, of.p}, keep, [op, rate](const State& state) {
      auto at = op;
      at.rate = rate.value_or(state.rate);
      return at;
    });
  });
}

Term make_volume_load(const Context& context, const VolumeCoupling& of, bool keep) {
  return with_slot(context, of.u, [&](auto slot) {
    const VolumeLoad<decltype(slot)> op{of.volume, of.reference};
    return Term(context, of.loop, {of.u}, {of.p}, keep, [op](const State&) { return op; });
  });
}

}  // namespace sprekk::assembly
