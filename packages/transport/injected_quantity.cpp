#include "transport/injected_quantity.hpp"

#include "transport/add_entry.hpp"

namespace sprekk::transport {

/// | symbol        | shape        | unit       |                                          |
/// | row, face     | [connection] | -          | of p and u; fracture face, -1 for rock   |
/// | constrained   | [connection] | -          | the pressure of the well is prescribed, else the rate |
/// | prescribes        | [connection] | -          | v is known                               |
/// | index         | [connection] | m^3/(Pa s) | W; with conduits divided by the transmissivity |
/// | driver        | [connection] | Pa or m^3/s | p_w or q                                |
/// | value         | [connection] | U          | v                                        |
struct InjectedQuantity::Kernel {
  ConstView<LocalIndex*> row, face;
  ConstView<char*> constrained, prescribes;
  ConstView<Real*> index, driver, value, p, u, widening;
  PresentConduits conduits;
  laws::Fluid fluid;
  Real capacity;
  FlowFactor change;

  KOKKOS_INLINE_FUNCTION bool widens() const { return conduits.conduit.extent(0) > 0; }
  KOKKOS_INLINE_FUNCTION Real unchanged(int k) const {
    return widens() ? index(k) * conduits.transmissivity(face(k), widening(face(k))) : index(k);
  }
  KOKKOS_INLINE_FUNCTION Real conductance(int k) const { return unchanged(k) * change.value(row(k)); }
  KOKKOS_INLINE_FUNCTION Real drop(int k) const { return fluid.drop(driver(k), p(row(k)), 0); }
  KOKKOS_INLINE_FUNCTION Real flow(int k) const { return constrained(k) ? conductance(k) * drop(k) : driver(k); }
  KOKKOS_INLINE_FUNCTION bool counts(int k) const { return prescribes(k) && flow(k) > 0; }
  KOKKOS_INLINE_FUNCTION Real rise(int k) const { return capacity * (u(row(k)) - value(k)); }
};

void InjectedQuantity::add(LocalIndex row, Real index, bool by_pressure, LocalIndex face) {
  rows_.push_back(row);
  indices_.push_back(index);
  by_pressure_.push_back(by_pressure);
  faces_.push_back(face);
}

void InjectedQuantity::bind(const assembly::Context& context, int pressure, int carried, const laws::Fluid& fluid,
                            Real capacity, const std::vector<laws::Conduit>& conduits,
                            const std::optional<FluidChange>& change) {
  pressure_ = pressure;
  if (change) {
    changing_ = context.field(change->field);
    response_ = change->response;
  }
  carried_ = carried;
  fluid_ = fluid;
  capacity_ = capacity;
  for (const auto row : rows_) owned_.push_back(row < context.layout(carried).n_owned());
  const auto of_owned = [&](auto values) {
    std::size_t n = 0;
    for (std::size_t k = 0; k < owned_.size(); ++k)
      if (owned_[k]) values[n++] = values[k];
    values.resize(n);
    return assembly::to_device(values, "connections");
  };
  row_ = of_owned(rows_);
  face_ = of_owned(faces_);
  index_ = of_owned(indices_);
  constrained_ = of_owned(by_pressure_);
  conduit_ = assembly::to_device(conduits, "conduits");
  if (!conduits.empty()) widening_ = context.field("widening");
  set(std::vector<Control>(rows_.size()));
}

void InjectedQuantity::set(const std::vector<Control>& controls) {
  std::vector<Real> drivers, values;
  std::vector<char> prescribes;
  for (std::size_t k = 0; k < owned_.size(); ++k) {
    if (!owned_[k]) continue;
    drivers.push_back(controls[k].driver);
    values.push_back(controls[k].value);
    prescribes.push_back(controls[k].prescribes);
  }
  driver_ = assembly::to_device(drivers, "pressures or rates");
  value_ = assembly::to_device(values, "values");
  prescribes_ = assembly::to_device(prescribes, "prescribes");
}

InjectedQuantity::Kernel InjectedQuantity::kernel(const assembly::State& state) const {
  return {row_,
          face_,
          constrained_,
          prescribes_,
          index_,
          driver_,
          value_,
          state.x[pressure_],
          state.x[carried_],
          widening_ < 0 ? ConstView<Real*>() : state.x[widening_],
          {conduit_, state.coefficients},
          fluid_,
          capacity_,
          {changing_ >= 0, response_, changing_ < 0 ? ConstView<Real*>() : ConstView<Real*>(state.x[changing_])}};
}

void InjectedQuantity::add_residual(const assembly::State& state, const assembly::Rows& r) const {
  const auto kernel = this->kernel(state);
  const auto rows = r[carried_];
  Kokkos::parallel_for(
      "injected quantity", Kokkos::RangePolicy<Execution>(0, row_.extent(0)), KOKKOS_LAMBDA(int k) {
        if (kernel.counts(k)) Kokkos::atomic_add(&rows(kernel.row(k)), kernel.flow(k) * kernel.rise(k));
      });
}

/// Assumes that columns of owned unknowns have the numbers of their rows.
void InjectedQuantity::add_jacobian(const assembly::State& state, fields::BlockMatrix& J) const {
  const auto kernel = this->kernel(state);
  const Kokkos::RangePolicy<Execution> all(0, row_.extent(0));
  const auto own = J(carried_, carried_)->getLocalMatrixDevice();
  const auto by_pressure = J(carried_, pressure_)->getLocalMatrixDevice();
  Kokkos::parallel_for(
      "injected quantity", all, KOKKOS_LAMBDA(int k) {
        if (!kernel.counts(k)) return;
        const LocalIndex row = kernel.row(k);
        add_entry(own, row, row, kernel.capacity * kernel.flow(k));
        if (kernel.constrained(k))
          add_entry(by_pressure, row, row,
                    kernel.conductance(k) * kernel.fluid.ddrop_db(kernel.driver(k), kernel.p(row), 0) * kernel.rise(k));
      });
  if (changing_ >= 0) {
    const auto by_changing = J(carried_, changing_)->getLocalMatrixDevice();
    Kokkos::parallel_for(
        "injected quantity", all, KOKKOS_LAMBDA(int k) {
          if (!kernel.counts(k) || !kernel.constrained(k)) return;
          const LocalIndex row = kernel.row(k);
          add_entry(by_changing, row, row,
                    kernel.unchanged(k) * kernel.change.slope(row) * kernel.drop(k) * kernel.rise(k));
        });
  }
  if (widening_ < 0 || J(carried_, widening_).is_null()) return;
  const auto by_widening = J(carried_, widening_)->getLocalMatrixDevice();
  Kokkos::parallel_for(
      "injected quantity", all, KOKKOS_LAMBDA(int k) {
        if (!kernel.counts(k) || !kernel.constrained(k)) return;
        const LocalIndex face = kernel.face(k);
        add_entry(by_widening, kernel.row(k), face,
                  kernel.index(k) * kernel.conduits.dtransmissivity(face, kernel.widening(face)) *
                      kernel.change.value(kernel.row(k)) * kernel.drop(k) * kernel.rise(k));
      });
}

}  // namespace sprekk::transport
