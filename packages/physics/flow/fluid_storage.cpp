#include "physics/flow/fluid_storage.hpp"

#include "assembly/assembler.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace sprekk::physics {

using assembly::Loop;

namespace {

/// | symbol   | shape    | unit     |                                                            |
/// | x        | 1        | Pa       | pressure p                                                 |
/// | r        | 1        | m^3/s    | rate V (phi e - phi_old e_old)                             |
/// | volume   | [entity] | m^3      | V, of fractures the area                                   |
/// | porosity | [entity] | -        | phi_0, of fractures the aperture, m                        |
/// | growth   | [entity] | 1/Pa     | c_phi                                                      |
/// | initial  | [entity] | Pa       | pressure at the start of the run                           |
/// | gained   | [owned entity, 1] | Pa | p_old less that                                         |
/// | rate     |          | 1/s      | of assembly::State                                         |
struct StorageCell {
  using Columns = assembly::Slots<assembly::Slot<1, 1>>;
  using Rows = Columns;
  laws::Fluid fluid;
  ConstView<Real*> volume, porosity, growth, initial;
  ConstView<Real**> gained;
  Real rate = 0;

  /// Of sums without cancellation, so that what all steps store adds up to what is stored.
  KOKKOS_INLINE_FUNCTION void residual(int e, const Real (&x)[1], Real (&r)[1]) const {
    r[0] = 0;
    if (e >= static_cast<int>(gained.extent(0))) return;  // another rank's
    const Real old = initial(e) + gained(e, 0), step = x[0] - initial(e) - gained(e, 0);
    const Real pores = porosity(e) + growth(e) * gained(e, 0);
    const Real denser = fluid.compressibility == 0 ? 0 : std::expm1(fluid.compressibility * step);
    r[0] = volume(e) * rate * (pores * fluid.density(old) * denser + growth(e) * step * fluid.density(x[0]));
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int e, const Real (&x)[1], Real (&J)[1][1]) const {
    const Real pores = porosity(e) + growth(e) * (x[0] - initial(e));
    J[0][0] = volume(e) * rate * fluid.density(x[0]) * (pores * fluid.compressibility + growth(e));
  }
};

/// The same of a fracture face whose aperture is a_0 and a widening b, the second of x, m:
/// r = rate |f| (a e - a_old e_old).
/// | gained   | [owned face, 2] | Pa, m | p_old less that at the start, b_old                        |
struct StorageFace : StorageCell {
  using Columns = assembly::Slots<assembly::Slot<1, 1>, assembly::Slot<1, 1>>;
  using Rows = assembly::Slots<assembly::Slot<1, 1>>;

  KOKKOS_INLINE_FUNCTION void residual(int e, const Real (&x)[2], Real (&r)[1]) const {
    const Real old = initial(e) + gained(e, 0), step = x[0] - initial(e) - gained(e, 0);
    const Real a_old = porosity(e) + gained(e, 1), opened = x[1] - gained(e, 1);
    const Real denser = fluid.compressibility == 0 ? 0 : std::expm1(fluid.compressibility * step);
    r[0] = volume(e) * rate * (a_old * fluid.density(old) * denser + opened * fluid.density(x[0]));
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int e, const Real (&x)[2], Real (&J)[1][2]) const {
    J[0][1] = volume(e) * rate * fluid.density(x[0]);
    J[0][0] = J[0][1] * (porosity(e) + x[1]) * fluid.compressibility;
  }
};

/// Of one entity.
struct Stored {
  Real volume;
  Pores pores;
  Real initial;
};

/// Finds what is stored in the entities of a loop, in their order.
using Find = std::function<std::vector<Stored>(const mesh::Mesh&)>;

template <class Op>
class FluidStorage final : public assembly::Module {
 public:
  static constexpr int n = Op::Columns::size;  // of the history

  FluidStorage(std::string name, std::string field, fields::Entity entity, Loop loop, laws::Fluid fluid, Find find)
      : name_(std::move(name)), field_(std::move(field)), entity_(entity), loop_(loop), find_(std::move(find)) {
    op_.fluid = fluid;
  }

  std::string name() const override { return name_; }

  assembly::Declaration declare(const mesh::Mesh&) const override {
    assembly::Declaration d;
    d.couplings = {{loop_, field_, {field_}}};
    if (n == 2) d.couplings[0].columns.push_back("widening");
    d.stores = true;
    d.history = {{n == 1 ? "gained pressure" : "gained pressure, widening", entity_, n}};
    return d;
  }

  void bind(const assembly::Context& context) override {
    pressure_ = context.field(field_);
    std::vector<Real> volume, porosity, growth, initial;
    for (const auto& stored : find_(*context.mesh())) {
      volume.push_back(stored.volume);
      porosity.push_back(stored.pores.porosity);
      growth.push_back(stored.pores.growth);
      initial.push_back(stored.initial);
      largest_ = std::max(largest_, std::abs(stored.initial));
    }
    op_.volume = assembly::to_device(volume, "volume");
    op_.porosity = assembly::to_device(porosity, "porosity");
    op_.growth = assembly::to_device(growth, "growth of pores");
    op_.initial = assembly::to_device(initial, "initial pressure");
    std::vector<int> columns = {pressure_};
    if (n == 2) columns.push_back(context.field("widening"));
    assembler_ =
        std::make_unique<Assembler>(context, loop_, std::vector<int>{pressure_}, columns, Assembler::Positions::keep);
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    assembler_->add_residual(at(state), state, r);
  }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    assembler_->add_jacobian(at(state), state, J);
  }

  assembly::Scales loads(Real) const override { return {{"pressure", largest_}}; }

  void commit(assembly::State& state) const override {
    const auto initial = op_.initial;
    const auto gained = state.history[0];
    assembler_->for_each(
        op_, state, KOKKOS_LAMBDA(int e, const Real(&x)[n]) {
          if (e >= static_cast<int>(gained.extent(0))) return;
          for (int k = 0; k < n; ++k) gained(e, k) = k == 0 ? x[0] - initial(e) : x[k];
        });
  }

 private:
  using Assembler = assembly::Assembler<Op>;

  Op at(const assembly::State& state) const {
    Op op = op_;
    op.gained = state.history[0];
    op.rate = state.rate;
    return op;
  }

  std::string name_, field_;
  fields::Entity entity_;
  Loop loop_;
  Find find_;
  int pressure_ = -1;
  Real largest_ = 0;  // initial pressure on this rank, Pa
  Op op_;
  std::unique_ptr<Assembler> assembler_;
};

/// The size of an entity, and the mean of the initial pressure there. `each` calls its argument with (measure, place)
/// of every point.
template <class Each>
Stored integrate(const Pores& pores, const base::Expression& initial, const Each& each) {
  Real total = 0, sum = 0;
  each([&](Real part, const std::array<Real, 3>& x) {
    total += part;
    sum += part * initial(x, 0);
  });
  return {total, pores, sum / total};
}

}  // namespace

std::unique_ptr<assembly::Module> make_fluid_storage(FluidStorageParameters parameters) {
  const auto fluid = parameters.fluid;
  const auto find = [parameters = std::move(parameters)](const mesh::Mesh& mesh) {
    const auto& of_cell = parameters.pores_of_cell;
    std::vector<Stored> stored;
    mesh::for_shape(mesh.shape, [&](auto shape) {
      for (LocalIndex c = 0; c < mesh.n_cells(); ++c)
        stored.push_back(integrate(parameters.pores[of_cell.empty() ? mesh.cell_region[c] : of_cell[c]],
                                   parameters.initial, [&](const auto& visit) {
                                     assembly::for_each_cell_point<shape()>(
                                         mesh, c, [&](const auto&, Real part, const auto& x) { visit(part, x); });
                                   }));
    });
    return stored;
  };
  return std::make_unique<FluidStorage<StorageCell>>("fluid storage", "pressure", fields::Entity::cell, Loop::cells,
                                                     fluid, find);
}

std::unique_ptr<assembly::Module> make_fracture_storage(FractureStorageParameters parameters) {
  const auto fluid = parameters.fluid;
  const bool widens = parameters.widens;
  const auto find = [parameters = std::move(parameters)](const mesh::Mesh& mesh) {
    std::vector<Stored> stored;
    mesh::for_shape(mesh.shape, [&](auto shape) {
      for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f)
        stored.push_back(integrate({parameters.aperture[f], 0}, parameters.initial, [&](const auto& visit) {
          const auto& face = mesh.fracture_faces[f];
          assembly::for_each_face_point<shape()>(mesh, face.cell[mesh::minus], face.local_face[mesh::minus],
                                                 [&](const auto&, Real part, const auto& x) { visit(part, x); });
        }));
    });
    return stored;
  };
  const auto make = [&](auto op) -> std::unique_ptr<assembly::Module> {
    return std::make_unique<FluidStorage<decltype(op)>>(
        "fracture storage", "face pressure", fields::Entity::fracture_face, Loop::fracture_faces, fluid, find);
  };
  return widens ? make(StorageFace()) : make(StorageCell());
}

}  // namespace sprekk::physics
