#include "transport/storage.hpp"

#include "assembly/assembler.hpp"
#include "assembly/capabilities.hpp"
#include "base/host_table.hpp"
#include "mesh/facets.hpp"
#include "transport/changed_flow.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace sprekk::transport {

using assembly::Loop;

namespace {

/// | symbol  | shape    | unit      |                                                             |
/// | x       | 1        | U         | u; U: Pa, or K for energy                                   |
/// | r       | 1        | m^3/s     | rate V (s - s_old); for energy W                            |
/// | volume  | [entity] | m^3       | V; for fractures the area                                   |
/// | room    | [entity] | -         | see Capacity; for fractures m                               |
/// | growth  | [entity] | 1/U       | see Capacity; for energy J/(m^3 K)                          |
/// | initial | [entity] | U         | u at the start of the run                                   |
/// | gained  | [owned entity, 1] | U | u_old minus `initial`                                      |
/// | rate    |          | 1/s       | of assembly::State                                          |
struct StorageCell {
  using Columns = assembly::Slots<assembly::Slot<1, 1>>;
  using Rows = Columns;
  laws::Fluid fluid;
  ConstView<Real*> volume, room, growth, initial;
  ConstView<Real**> gained;
  Real rate = 0;

  /// Computes the row without cancellation, so the increments of all steps add up to the stored amount.
  KOKKOS_INLINE_FUNCTION void residual(int e, const Real (&x)[1], Real (&r)[1]) const {
    r[0] = 0;
    if (e >= static_cast<int>(gained.extent(0))) return;  // entity of another rank
    const Real old = initial(e) + gained(e, 0), step = x[0] - initial(e) - gained(e, 0);
    const Real space = room(e) + growth(e) * gained(e, 0);
    const Real denser = fluid.compressibility == 0 ? 0 : std::expm1(fluid.compressibility * step);
    r[0] = volume(e) * rate * (space * fluid.density(old) * denser + growth(e) * step * fluid.density(x[0]));
  }
  /// Returns V s, now and at the start of the step.
  KOKKOS_INLINE_FUNCTION Real stored(int e, const Real (&x)[1]) const {
    return volume(e) * (room(e) + growth(e) * (x[0] - initial(e))) * fluid.density(x[0]);
  }
  KOKKOS_INLINE_FUNCTION Real stored_before(int e) const { return stored(e, {initial(e) + gained(e, 0)}); }
  /// Returns the increase of s since the start, by default up to the start of the step.
  KOKKOS_INLINE_FUNCTION Real increase(int e) const { return increase(e, gained(e, 0)); }
  KOKKOS_INLINE_FUNCTION Real increase(int e, Real change) const {
    const Real denser = fluid.compressibility == 0 ? 0 : std::expm1(fluid.compressibility * change);
    return room(e) * fluid.density(initial(e)) * denser + growth(e) * change * fluid.density(initial(e) + change);
  }
  KOKKOS_INLINE_FUNCTION Real slope(int e, Real change) const {
    const Real space = room(e) + growth(e) * change;
    return fluid.density(initial(e) + change) * (space * fluid.compressibility + growth(e));
  }
  /// Returns the change of u since the start for an increase of s, by Newton's method; `change` if nothing is stored.
  KOKKOS_INLINE_FUNCTION Real change_for(int e, Real increased, Real change) const {
    for (int iteration = 0; iteration < 20 && slope(e, change) > 0; ++iteration) {
      const Real step = (increased - increase(e, change)) / slope(e, change);
      change += step;
      if (std::abs(step) <= 1e-15 * std::abs(change)) break;
    }
    return change;
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int e, const Real (&x)[1], Real (&J)[1][1]) const {
    J[0][0] = volume(e) * rate * slope(e, x[0] - initial(e));
  }
};

/// Storage in a fracture face with the volume of fluid per area a = max(a_0 + s b, a_min). The widening b, m, is the
/// second unknown: r = rate |f| (a e - a_old e_old).
///
/// | gained   | [owned face, 2] | Pa, m | p_old minus the initial p; b_old                           |
/// | minimum    | [local face]    | m     | a_min                                                      |
/// | share      | [local face]    | -     | s                                                          |
struct StorageFace : StorageCell {
  using Columns = assembly::Slots<assembly::Slot<1, 1>, assembly::Slot<1, 1>>;
  using Rows = assembly::Slots<assembly::Slot<1, 1>>;
  ConstView<Real*> minimum, share;

  KOKKOS_INLINE_FUNCTION bool is_wide(int e, Real widening) const { return room(e) + share(e) * widening > minimum(e); }
  KOKKOS_INLINE_FUNCTION Real aperture(int e, Real widening) const {
    return is_wide(e, widening) ? room(e) + share(e) * widening : minimum(e);
  }
  KOKKOS_INLINE_FUNCTION void residual(int e, const Real (&x)[2], Real (&r)[1]) const {
    const Real old = initial(e) + gained(e, 0), step = x[0] - initial(e) - gained(e, 0);
    const Real a_old = aperture(e, gained(e, 1));
    const Real opened =
        is_wide(e, x[1]) && is_wide(e, gained(e, 1)) ? share(e) * (x[1] - gained(e, 1)) : aperture(e, x[1]) - a_old;
    const Real denser = fluid.compressibility == 0 ? 0 : std::expm1(fluid.compressibility * step);
    r[0] = volume(e) * rate * (a_old * fluid.density(old) * denser + opened * fluid.density(x[0]));
  }
  KOKKOS_INLINE_FUNCTION Real stored(int e, const Real (&x)[2]) const {
    return volume(e) * aperture(e, x[1]) * fluid.density(x[0]);
  }
  KOKKOS_INLINE_FUNCTION Real stored_before(int e) const {
    return stored(e, {initial(e) + gained(e, 0), gained(e, 1)});
  }
  KOKKOS_INLINE_FUNCTION Real increase(int e) const {
    const Real full = aperture(e, 0), now = aperture(e, gained(e, 1)), change = gained(e, 0);
    const Real denser = fluid.compressibility == 0 ? 0 : std::expm1(fluid.compressibility * change);
    return full * fluid.density(initial(e)) * denser + (now - full) * fluid.density(initial(e) + change);
  }
  /// Within a tolerance of the least aperture, the derivative is that of an opening face. Otherwise, the sign of the
  /// rounding error of the widening would select the next iterate of a face at rest, and thus one of several solutions.
  KOKKOS_INLINE_FUNCTION void jacobian(int e, const Real (&x)[2], Real (&J)[1][2]) const {
    constexpr Real tolerance = 1e-5;  // of the least aperture
    const Real density = volume(e) * rate * fluid.density(x[0]);
    J[0][1] = is_wide(e, x[1] + tolerance * minimum(e)) ? share(e) * density : 0;
    J[0][0] = density * aperture(e, x[1]) * fluid.compressibility;
  }
};

/// Storage with the density multiplied by d(v), see laws::FluidResponse. v is the last component of x and of `gained`.
template <class Op>
struct Changed {
  static constexpr int m = Op::Columns::size;
  using Columns = typename Joined<typename Op::Columns, assembly::Slots<assembly::Slot<1, 1>>>::Slots;
  using Rows = typename Op::Rows;
  Op base;
  laws::FluidResponse response;

  KOKKOS_INLINE_FUNCTION void residual(int e, const Real (&x)[m + 1], Real (&r)[1]) const {
    r[0] = 0;
    if (e >= static_cast<int>(base.gained.extent(0))) return;  // entity of another rank
    Real own[m];
    for (int k = 0; k < m; ++k) own[k] = x[k];
    const Real d = response.density(x[m]).value, d_old = response.density(base.gained(e, m)).value;
    base.residual(e, own, r);
    r[0] = d * r[0] + base.rate * base.stored_before(e) * (d - d_old);
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int e, const Real (&x)[m + 1], Real (&J)[1][m + 1]) const {
    Real own[m], by_own[1][m];
    for (int k = 0; k < m; ++k) own[k] = x[k];
    const auto d = response.density(x[m]);
    base.jacobian(e, own, by_own);
    for (int k = 0; k < m; ++k) J[0][k] = d.value * by_own[0][k];
    J[0][m] = base.rate * base.stored(e, own) * d.slope;
  }
};

/// Storage data of one entity.
struct Stored {
  Real volume;
  Capacity capacity;
  Real initial;
  Real carried = 0;  ///< initial value of the field that changes the fluid
  Real minimum = 0;  ///< residual aperture of a fracture, m
  Real share = 1;    ///< see FractureStorageParameters
};

/// Computes the storage data of the entities of a loop, in their order.
using Find = std::function<std::vector<Stored>(const mesh::Mesh&)>;

template <class Op, bool changes>
class Storage final : public assembly::Module,
                      public assembly::Loads,
                      public assembly::InitialValues,
                      public assembly::Steps,
                      public assembly::Transfer,
                      public assembly::Totals {
 public:
  static constexpr int m = Op::Columns::size, n = m + changes;  // components of the history

  struct Of {
    std::string name, field, scale, amount;
    fields::Entity entity;
    Loop loop;
    std::string carried;  ///< field that changes the fluid
    laws::FluidResponse response;
  };
  Storage(Of of, laws::Fluid fluid, Find find) : of_(std::move(of)), find_(std::move(find)) { op_.fluid = fluid; }

  std::string name() const override { return of_.name; }

  assembly::Declaration declare(const mesh::Mesh&) const override {
    assembly::Declaration d;
    d.couplings = {{of_.loop, of_.field, columns()}};
    d.stores = true;
    const std::string saved = std::string(m == 2 ? ", widening" : "") + (changes ? ", " + of_.carried : "");
    d.history = {{"gained " + of_.scale + saved, of_.entity, n}};
    return d;
  }

  void bind(const assembly::Context& context) override {
    std::vector<Real> volume, room, growth, initial, minimum, share;
    for (const auto& stored : find_(*context.mesh())) {
      volume.push_back(stored.volume);
      room.push_back(stored.capacity.room);
      growth.push_back(stored.capacity.growth);
      initial.push_back(stored.initial);
      minimum.push_back(stored.minimum);
      share.push_back(stored.share);
      carried_.push_back(stored.carried);
      largest_ = std::max(largest_, std::abs(stored.initial));
    }
    unit_ = of_.amount;
    if (context.mesh()->dim() == 2) unit_ = of_.amount == "m^3" ? "m^2" : of_.amount + "/m";
    op_.volume = assembly::to_device(volume, "volume");
    op_.room = assembly::to_device(room, "room");
    op_.growth = assembly::to_device(growth, "growth");
    op_.initial = assembly::to_device(initial, "initial values");
    if constexpr (m == 2) {
      op_.minimum = assembly::to_device(minimum, "residual aperture");
      op_.share = assembly::to_device(share, "share");
    }
    std::vector<int> columns;
    for (const auto& name : this->columns()) columns.push_back(context.field(name));
    assembler_ =
        std::make_unique<Assembler>(context, of_.loop, std::vector{columns[0]}, columns, Assembler::Positions::keep);
  }

  void initial_history(const std::vector<View<Real**>>& history) const override {
    if (!changes) return;
    const auto saved = base::to_host(history[0]);
    for (std::size_t e = 0; e < saved.extent(0); ++e) saved(e, m) = carried_[e];
    Kokkos::deep_copy(history[0], saved);
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    assembler_->add_residual(at(state), state, r);
  }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    assembler_->add_jacobian(at(state), state, J);
  }

  assembly::Scales loads(Real) const override { return {{of_.scale, largest_}}; }

  void totals(const assembly::State& state, std::vector<assembly::Total>& totals) const override {
    if constexpr (!changes) {
      if (of_.amount.empty()) return;
      const auto op = at(state);
      Real sum = 0;
      Kokkos::parallel_reduce(
          "stored", Kokkos::RangePolicy<Execution>(0, op.gained.extent(0)),
          KOKKOS_LAMBDA(int e, Real& part) { part += op.volume(e) * op.increase(e); }, sum);
      totals.push_back({{"stored", of_.name}, sum, unit_});
    }
  }

  /// Entities without a history, such as new channels, are full of fluid in the present state.
  void take_over(assembly::State& state) const override { commit(state); }
  void to_conserved(assembly::State& state) const override {
    convert(state, [](const auto& op, int e, Real) { return op.increase(e); });
  }
  void from_conserved(assembly::State& state) const override {
    convert(state, [](const auto& op, int e, Real x) { return op.change_for(e, op.gained(e, 0), x - op.initial(e)); });
  }
  void commit(assembly::State& state) const override {
    const auto initial = op_.initial;
    const auto gained = state.history[0];
    assembler_->for_each(
        at(state), state, KOKKOS_LAMBDA(int e, const Real(&x)[n]) {
          if (e >= static_cast<int>(gained.extent(0))) return;
          for (int k = 0; k < n; ++k) gained(e, k) = k == 0 ? x[0] - initial(e) : x[k];
        });
  }

  /// Replaces the histories of cells by how(op, cell, u). A fluid that another field changes has no such cells in rock
  /// whose nodes move.
  template <class How>
  void convert(assembly::State& state, const How& how) const {
    if constexpr (m == 1 && !changes) {
      if (of_.entity != fields::Entity::cell) return;
      const auto op = at(state);
      const auto saved = state.history[0];
      assembler_->for_each(
          op, state, KOKKOS_LAMBDA(int e, const Real(&x)[n]) {
            if (e < static_cast<int>(saved.extent(0))) saved(e, 0) = how(op, e, x[0]);
          });
    }
  }

 private:
  using Whole = std::conditional_t<changes, Changed<Op>, Op>;
  using Assembler = assembly::Assembler<Whole>;

  Whole at(const assembly::State& state) const {
    Op op = op_;
    op.gained = state.history[0];
    op.rate = state.rate;
    if constexpr (changes)
      return {op, of_.response};
    else
      return op;
  }
  std::vector<std::string> columns() const {
    std::vector<std::string> fields = {of_.field};
    if (m == 2) fields.push_back("widening");
    if (changes) fields.push_back(of_.carried);
    return fields;
  }

  Of of_;
  Find find_;
  std::string unit_;
  std::vector<Real> carried_;  // [entity] at the start
  Real largest_ = 0;           // largest absolute initial value on this rank
  Op op_;
  std::unique_ptr<Assembler> assembler_;
};

/// Creates the module. `prefix`: prefix of the field that changes the fluid.
template <class Op>
std::unique_ptr<assembly::Module> module_of(std::string name, std::string field, std::string scale, std::string amount,
                                            fields::Entity entity, Loop loop, const std::string& prefix,
                                            const std::optional<FluidChange>& change, const laws::Fluid& fluid,
                                            Find find) {
  const auto make = [&](auto changes) -> std::unique_ptr<assembly::Module> {
    using Module = Storage<Op, changes()>;
    typename Module::Of of{.name = std::move(name),
                           .field = std::move(field),
                           .scale = std::move(scale),
                           .amount = std::move(amount),
                           .entity = entity,
                           .loop = loop,
                           .carried = change ? prefix + change->field : "",
                           .response = change ? change->response : laws::FluidResponse()};
    return std::make_unique<Module>(std::move(of), fluid, std::move(find));
  };
  return change ? make(std::true_type()) : make(std::false_type());
}

}  // namespace

std::unique_ptr<assembly::Module> make_storage(StorageParameters parameters) {
  const auto find = [parameters](const mesh::Mesh& mesh) {
    std::vector<Stored> stored;
    const auto mean = [&](LocalIndex c, const base::Expression& of) {
      return assembly::cell_mean(mesh, c, [&](const auto& x) { return of(x, 0); });
    };
    for (LocalIndex c = 0; c < mesh.n_cells(); ++c) {
      const auto [volume, initial] = mean(c, parameters.initial);
      stored.push_back({.volume = volume,
                        .capacity = parameters.capacity.of_cell(mesh, c),
                        .initial = initial,
                        .carried = parameters.change ? mean(c, parameters.change->initial)[1] : 0});
    }
    return stored;
  };
  return module_of<StorageCell>(parameters.name, parameters.field, parameters.field, parameters.amount,
                                fields::Entity::cell, Loop::cells, "", parameters.change, parameters.fluid, find);
}

std::unique_ptr<assembly::Module> make_edge_storage(StorageParameters parameters, std::vector<EdgeCapacity> edges) {
  const auto find = [parameters, edges = std::move(edges)](const mesh::Mesh& mesh) {
    std::vector<Stored> stored(mesh.facets->n_owned, Stored{.volume = 0, .capacity = {0, 0}, .initial = 0});
    for (const auto& edge : edges)
      stored[edge.facet] = {.volume = edge.length,
                            .capacity = edge.capacity,
                            .initial = parameters.initial(edge.centre, 0),
                            .carried = parameters.change ? parameters.change->initial(edge.centre, 0) : 0};
    return stored;
  };
  return module_of<StorageCell>("edge storage of " + parameters.field, "face " + parameters.field, parameters.field,
                                parameters.amount, fields::Entity::facet, Loop::facets, "face ", parameters.change,
                                parameters.fluid, find);
}

std::unique_ptr<assembly::Module> make_fracture_storage(FractureStorageParameters parameters) {
  const auto find = [parameters](const mesh::Mesh& mesh) {
    std::vector<Stored> stored;
    const auto mean = [&](const mesh::Mesh::FractureFace& face, const base::Expression& of) {
      return assembly::face_mean(mesh, face.cell[mesh::minus], face.local_face[mesh::minus],
                                 [&](const auto&, const auto& x) { return of(x, 0); });
    };
    for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
      const auto& face = mesh.fracture_faces[f];
      stored.push_back({.volume = face.area,
                        .capacity = {.room = parameters.aperture[f], .growth = 0},
                        .initial = mean(face, parameters.initial),
                        .carried = parameters.change ? mean(face, parameters.change->initial) : 0,
                        .minimum = parameters.minimum[f],
                        .share = parameters.share.empty() ? 1 : parameters.share[f]});
    }
    return stored;
  };
  const auto make = [&](auto op) {
    return module_of<decltype(op)>("fracture storage", "face pressure", "pressure", "m^3",
                                   fields::Entity::fracture_face, Loop::fracture_faces, "face ", parameters.change,
                                   parameters.fluid, find);
  };
  return parameters.widens ? make(StorageFace()) : make(StorageCell());
}

}  // namespace sprekk::transport
