#include "physics/storage.hpp"

#include "assembly/assembler.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace sprekk::physics {

using assembly::Loop;

namespace {

/// | symbol  | shape    | unit      |                                                             |
/// | x       | 1        | U         | u: Pa, of energy K                                          |
/// | r       | 1        | m^3/s     | rate V (s - s_old), of energy W                             |
/// | volume  | [entity] | m^3       | V, of fractures the area                                    |
/// | room    | [entity] | -         | see Capacity, of fractures m                                |
/// | growth  | [entity] | 1/U       | of energy J/(m^3 K)                                         |
/// | initial | [entity] | U         | u at the start of the run                                   |
/// | gained  | [owned entity, 1] | U | u_old less that                                            |
/// | rate    |          | 1/s       | of assembly::State                                          |
struct StorageCell {
  using Columns = assembly::Slots<assembly::Slot<1, 1>>;
  using Rows = Columns;
  laws::Fluid fluid;
  ConstView<Real*> volume, room, growth, initial;
  ConstView<Real**> gained;
  Real rate = 0;

  /// Of sums without cancellation, so that what all steps store adds up to what is stored.
  KOKKOS_INLINE_FUNCTION void residual(int e, const Real (&x)[1], Real (&r)[1]) const {
    r[0] = 0;
    if (e >= static_cast<int>(gained.extent(0))) return;  // another rank's
    const Real old = initial(e) + gained(e, 0), step = x[0] - initial(e) - gained(e, 0);
    const Real space = room(e) + growth(e) * gained(e, 0);
    const Real denser = fluid.compressibility == 0 ? 0 : std::expm1(fluid.compressibility * step);
    r[0] = volume(e) * rate * (space * fluid.density(old) * denser + growth(e) * step * fluid.density(x[0]));
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int e, const Real (&x)[1], Real (&J)[1][1]) const {
    const Real space = room(e) + growth(e) * (x[0] - initial(e));
    J[0][0] = volume(e) * rate * fluid.density(x[0]) * (space * fluid.compressibility + growth(e));
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
    const Real a_old = room(e) + gained(e, 1), opened = x[1] - gained(e, 1);
    const Real denser = fluid.compressibility == 0 ? 0 : std::expm1(fluid.compressibility * step);
    r[0] = volume(e) * rate * (a_old * fluid.density(old) * denser + opened * fluid.density(x[0]));
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int e, const Real (&x)[2], Real (&J)[1][2]) const {
    J[0][1] = volume(e) * rate * fluid.density(x[0]);
    J[0][0] = J[0][1] * (room(e) + x[1]) * fluid.compressibility;
  }
};

/// Of one entity.
struct Stored {
  Real volume;
  Capacity capacity;
  Real initial;
};

/// Finds what is stored in the entities of a loop, in their order.
using Find = std::function<std::vector<Stored>(const mesh::Mesh&)>;

template <class Op>
class Storage final : public assembly::Module {
 public:
  static constexpr int n = Op::Columns::size;  // of the history

  struct Of {
    std::string name, field, scale;
    fields::Entity entity;
    Loop loop;
  };
  Storage(Of of, laws::Fluid fluid, Find find) : of_(std::move(of)), find_(std::move(find)) { op_.fluid = fluid; }

  std::string name() const override { return of_.name; }

  assembly::Declaration declare(const mesh::Mesh&) const override {
    assembly::Declaration d;
    d.couplings = {{of_.loop, of_.field, {of_.field}}};
    if (n == 2) d.couplings[0].columns.push_back("widening");
    d.stores = true;
    d.history = {{"gained " + of_.scale + (n == 2 ? ", widening" : ""), of_.entity, n}};
    return d;
  }

  void bind(const assembly::Context& context) override {
    const int field = context.field(of_.field);
    std::vector<Real> volume, room, growth, initial;
    for (const auto& stored : find_(*context.mesh())) {
      volume.push_back(stored.volume);
      room.push_back(stored.capacity.room);
      growth.push_back(stored.capacity.growth);
      initial.push_back(stored.initial);
      largest_ = std::max(largest_, std::abs(stored.initial));
    }
    op_.volume = assembly::to_device(volume, "volume");
    op_.room = assembly::to_device(room, "room");
    op_.growth = assembly::to_device(growth, "growth");
    op_.initial = assembly::to_device(initial, "initial values");
    std::vector<int> columns = {field};
    if (n == 2) columns.push_back(context.field("widening"));
    assembler_ =
        std::make_unique<Assembler>(context, of_.loop, std::vector{field}, columns, Assembler::Positions::keep);
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    assembler_->add_residual(at(state), state, r);
  }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    assembler_->add_jacobian(at(state), state, J);
  }

  assembly::Scales loads(Real) const override { return {{of_.scale, largest_}}; }

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

  Of of_;
  Find find_;
  Real largest_ = 0;  // initial value on this rank
  Op op_;
  std::unique_ptr<Assembler> assembler_;
};

}  // namespace

std::unique_ptr<assembly::Module> make_storage(StorageParameters parameters) {
  const Storage<StorageCell>::Of of{.name = parameters.name,
                                    .field = parameters.field,
                                    .scale = parameters.field,
                                    .entity = fields::Entity::cell,
                                    .loop = Loop::cells};
  const auto fluid = parameters.fluid;
  return std::make_unique<Storage<StorageCell>>(of, fluid, [parameters = std::move(parameters)](const auto& mesh) {
    std::vector<Stored> stored;
    mesh::for_shape(mesh.shape, [&](auto shape) {
      for (LocalIndex c = 0; c < mesh.n_cells(); ++c) {
        const auto [volume, initial] =
            assembly::cell_mean<shape()>(mesh, c, [&](const auto& x) { return parameters.initial(x, 0); });
        stored.push_back({.volume = volume, .capacity = parameters.capacity.of_cell(mesh, c), .initial = initial});
      }
    });
    return stored;
  });
}

std::unique_ptr<assembly::Module> make_fracture_storage(FractureStorageParameters parameters) {
  const auto make = [&](auto op) -> std::unique_ptr<assembly::Module> {
    using Module = Storage<decltype(op)>;
    const typename Module::Of of{.name = "fracture storage",
                                 .field = "face pressure",
                                 .scale = "pressure",
                                 .entity = fields::Entity::fracture_face,
                                 .loop = Loop::fracture_faces};
    return std::make_unique<Module>(of, parameters.fluid, [parameters](const mesh::Mesh& mesh) {
      std::vector<Stored> stored;
      mesh::for_shape(mesh.shape, [&](auto shape) {
        for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
          const auto& face = mesh.fracture_faces[f];
          const Real initial =
              assembly::face_mean<shape()>(mesh, face.cell[mesh::minus], face.local_face[mesh::minus],
                                           [&](const auto&, const auto& x) { return parameters.initial(x, 0); });
          stored.push_back(
              {.volume = face.area, .capacity = {.room = parameters.aperture[f], .growth = 0}, .initial = initial});
        }
      });
      return stored;
    });
  };
  return parameters.widens ? make(StorageFace()) : make(StorageCell());
}

}  // namespace sprekk::physics
