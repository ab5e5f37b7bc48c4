#include "transport/exchange.hpp"

#include "transport/add_entry.hpp"

namespace sprekk::transport {

/// Coefficient of one exchange and its derivatives by the widening of its face and by the field of FluidChange.
struct Exchange::Coefficient {
  ConstView<Real*> factor, widening;
  ConstView<LocalIndex*> row, face;
  PresentConduits conduits;
  FlowFactor fluid;

  KOKKOS_INLINE_FUNCTION bool widens() const { return conduits.conduit.extent(0) > 0; }
  KOKKOS_INLINE_FUNCTION Real operator()(int k) const { return own(k) * fluid.value(row(k)); }
  KOKKOS_INLINE_FUNCTION Real by_widening(int k) const {
    return factor(k) * conduits.dtransmissivity(face(k), widening(face(k))) * fluid.value(row(k));
  }
  KOKKOS_INLINE_FUNCTION Real by_carried(int k) const { return own(k) * fluid.slope(row(k)); }

 private:
  KOKKOS_INLINE_FUNCTION Real own(int k) const {
    return widens() ? factor(k) * conduits.transmissivity(face(k), widening(face(k))) : factor(k);
  }
};

void Exchange::add(LocalIndex row, Real coefficient, LocalIndex face) {
  rows_.push_back(row);
  coefficients_.push_back(coefficient);
  faces_.push_back(face);
}

void Exchange::bind(const assembly::Context& context, int block, const laws::Fluid& fluid,
                    const std::vector<laws::Conduit>& conduits, const std::optional<FluidChange>& change) {
  block_ = block;
  if (change) {
    carried_ = context.field(change->field);
    response_ = change->response;
  }
  fluid_ = fluid;
  std::vector<LocalIndex> rows, faces;
  std::vector<Real> coefficients;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    owned_.push_back(rows_[k] < context.layout(block).n_owned());
    if (!owned_.back()) continue;
    rows.push_back(rows_[k]);
    faces.push_back(faces_[k]);
    coefficients.push_back(coefficients_[k]);
  }
  row_ = assembly::to_device(rows, "rows");
  face_ = assembly::to_device(faces, "faces");
  coefficient_ = assembly::to_device(coefficients, "coefficients");
  conduit_ = assembly::to_device(conduits, "conduits");
  if (!conduits.empty()) widening_ = context.field("widening");
  set_outside(std::vector<Real>(rows_.size(), 0));
}

void Exchange::set_outside(const std::vector<Real>& pressures) {
  std::vector<Real> of_owned;
  for (std::size_t k = 0; k < owned_.size(); ++k)
    if (owned_[k]) of_owned.push_back(pressures[k]);
  outside_ = assembly::to_device(of_owned, "pressures outside");
}

Exchange::Coefficient Exchange::coefficient(const assembly::State& state) const {
  const auto field = [&](int block) { return block < 0 ? ConstView<Real*>() : ConstView<Real*>(state.x[block]); };
  return {coefficient_,
          field(widening_),
          row_,
          face_,
          {conduit_, state.coefficients},
          {carried_ >= 0, response_, field(carried_)}};
}

void Exchange::add_residual(const assembly::State& state, const assembly::Rows& r) const {
  const auto fluid = fluid_;
  const auto row = row_;
  const auto outside = outside_;
  const auto coefficient = this->coefficient(state);
  const auto x = state.x[block_];
  const auto rows = r[block_];
  Kokkos::parallel_for(
      "exchange", Kokkos::RangePolicy<Execution>(0, row.extent(0)), KOKKOS_LAMBDA(int k) {
        Kokkos::atomic_add(&rows(row(k)), coefficient(k) * fluid.drop(x(row(k)), outside(k), 0));
      });
}

/// Assumes that columns of owned unknowns have the numbers of their rows.
void Exchange::add_jacobian(const assembly::State& state, fields::BlockMatrix& J) const {
  const auto fluid = fluid_;
  const auto row = row_, face = face_;
  const auto outside = outside_;
  const auto coefficient = this->coefficient(state);
  const auto x = state.x[block_];
  const auto local = J(block_, block_)->getLocalMatrixDevice();
  Kokkos::parallel_for(
      "exchange", Kokkos::RangePolicy<Execution>(0, row.extent(0)), KOKKOS_LAMBDA(int k) {
        add_entry(local, row(k), row(k), coefficient(k) * fluid.ddrop_da(x(row(k)), outside(k), 0));
      });
  if (carried_ >= 0) {
    const auto by_carried = J(block_, carried_)->getLocalMatrixDevice();
    Kokkos::parallel_for(
        "exchange", Kokkos::RangePolicy<Execution>(0, row.extent(0)), KOKKOS_LAMBDA(int k) {
          add_entry(by_carried, row(k), row(k), coefficient.by_carried(k) * fluid.drop(x(row(k)), outside(k), 0));
        });
  }
  if (widening_ < 0 || J(block_, widening_).is_null()) return;
  const auto by_widening = J(block_, widening_)->getLocalMatrixDevice();
  Kokkos::parallel_for(
      "exchange", Kokkos::RangePolicy<Execution>(0, row.extent(0)), KOKKOS_LAMBDA(int k) {
        add_entry(by_widening, row(k), face(k), coefficient.by_widening(k) * fluid.drop(x(row(k)), outside(k), 0));
      });
}

}  // namespace sprekk::transport
