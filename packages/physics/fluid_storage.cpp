#include "physics/fluid_storage.hpp"

#include "assembly/assembler.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::physics {

using assembly::Loop;

namespace {

/// | symbol   | shape  | unit     |                                                            |
/// | x        | 1      | Pa       | pressure p                                                 |
/// | r        | 1      | m^3/s    | S V (p - p_old)/dt                                         |
/// | capacity | [cell] | m^3/Pa   | S V                                                        |
/// | initial  | [cell] | Pa       | pressure at the start of the run                           |
/// | gained   | [owned cell, 1] | Pa | p_old less that                                         |
/// | rate     |        | 1/s      | 1/dt                                                       |
struct StorageCell {
  using Columns = assembly::Slots<assembly::Slot<1, 1>>;
  using Rows = Columns;
  ConstView<Real*> capacity, initial;
  ConstView<Real**> gained;
  Real rate = 0;

  KOKKOS_INLINE_FUNCTION void residual(int e, const Real (&x)[1], Real (&r)[1]) const {
    const bool owned = e < static_cast<int>(gained.extent(0));
    r[0] = owned ? capacity(e) * rate * (x[0] - initial(e) - gained(e, 0)) : 0;
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int e, const Real (&)[1], Real (&J)[1][1]) const {
    J[0][0] = capacity(e) * rate;
  }
};

class FluidStorage final : public assembly::Module {
 public:
  explicit FluidStorage(FluidStorageParameters parameters) : parameters_(std::move(parameters)) {}

  std::string name() const override { return "fluid storage"; }

  assembly::Declaration declare() const override {
    assembly::Declaration d;
    d.couplings = {{Loop::cells, "pressure", {"pressure"}}};
    d.history = {{"gained pressure", fields::Entity::cell, 1}};
    return d;
  }

  void bind(const assembly::Context& context) override {
    const auto mesh = context.mesh();
    pressure_ = context.field("pressure");
    View<Real*> capacity("capacity", mesh->n_cells()), initial("initial pressure", mesh->n_cells());
    const auto S = Kokkos::create_mirror_view(capacity), p = Kokkos::create_mirror_view(initial);
    mesh::for_shape(mesh->shape, [&](auto shape) {
      for (LocalIndex c = 0; c < mesh->n_cells(); ++c) {
        Real volume = 0, sum = 0;
        assembly::for_each_cell_point<shape()>(*mesh, c, [&](const auto&, Real part, const auto& x) {
          volume += part;
          sum += part * parameters_.initial(x, 0);
        });
        const auto& of_cell = parameters_.storage_of_cell;
        S(c) = volume * parameters_.storage[of_cell.empty() ? mesh->cell_region[c] : of_cell[c]];
        p(c) = sum / volume;
        largest_ = std::max(largest_, std::abs(p(c)));
      }
    });
    Kokkos::deep_copy(capacity, S);
    Kokkos::deep_copy(initial, p);
    op_.capacity = capacity;
    op_.initial = initial;
    assembler_ = std::make_unique<Assembler>(context, Loop::cells, std::vector<int>{pressure_},
                                             std::vector<int>{pressure_}, Assembler::Positions::keep);
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    assembler_->add_residual(at(state), state, r);
  }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    assembler_->add_jacobian(at(state), state, J);
  }

  Real fluid_load(Real) const override { return largest_; }

  void commit(assembly::State& state) const override {
    const auto p = state.x[pressure_];
    const auto initial = op_.initial;
    const auto gained = state.history[0];
    Kokkos::parallel_for(
        "commit", Kokkos::RangePolicy<Execution>(0, gained.extent(0)),
        KOKKOS_LAMBDA(int c) { gained(c, 0) = p(c) - initial(c); });
  }

 private:
  using Assembler = assembly::Assembler<StorageCell>;

  StorageCell at(const assembly::State& state) const {
    StorageCell op = op_;
    op.gained = state.history[0];
    op.rate = 1 / state.dt;
    return op;
  }

  FluidStorageParameters parameters_;
  int pressure_ = -1;
  Real largest_ = 0;  // initial pressure on this rank, Pa
  StorageCell op_;
  std::unique_ptr<Assembler> assembler_;
};

}  // namespace

std::unique_ptr<assembly::Module> make_fluid_storage(FluidStorageParameters parameters) {
  return std::make_unique<FluidStorage>(std::move(parameters));
}

}  // namespace sprekk::physics
