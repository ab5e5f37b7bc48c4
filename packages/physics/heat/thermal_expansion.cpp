#include "physics/heat/thermal_expansion.hpp"

#include "assembly/assembler.hpp"
#include "assembly/capabilities.hpp"
#include "assembly/geometry.hpp"
#include "assembly/volume_work.hpp"
#include "base/host_table.hpp"
#include "base/over_ranks.hpp"
#include "mesh/facets.hpp"
#include "physics/mechanics/displacements.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprekk::physics {

using assembly::Loop;
using assembly::Slot;

namespace {

class ThermalStress final : public assembly::Module, public assembly::Loads {
 public:
  explicit ThermalStress(ThermalStressParameters parameters) : parameters_(std::move(parameters)) {}

  std::string name() const override { return "thermal stress"; }
  std::string fingerprint() const override { return parameters_.initial.text(); }

  assembly::Declaration declare(const mesh::Mesh& mesh) const override {
    assembly::Declaration d;
    for (const auto& part : assembly::divergence_fields(mesh, displacements))
      d.couplings.push_back({part.loop, part.field, {"temperature"}});
    d.outputs = {{{"thermal stress", "Pa", fields::Entity::cell, 1}, [this](const auto& s) { return stresses(s); }}};
    d.linear = true;
    return d;
  }

  void bind(const assembly::Context& context) override {
    mesh_ = context.mesh();
    temperature_ = context.field("temperature");
    for (LocalIndex c = 0; c < mesh_->n_cells(); ++c) {
      reference_.push_back(initial(c));
      largest_ = std::max(largest_, stiffness(c));
    }
    const auto parts = assembly::divergence(*mesh_, displacements, [this](LocalIndex cell) { return stiffness(cell); });
    for (const auto& part : parts) {
      std::vector<Real> start;
      for (const LocalIndex cell : part.cells) start.push_back(reference_[cell]);
      terms_.push_back(assembly::make_volume_load(context,
                                                  {part.loop, context.field(part.field), temperature_, part.volume,
                                                   assembly::to_device(start, "temperature at the start")},
                                                  false));
    }
    find_sizes();
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    for (const auto& term : terms_) term.add_residual(state, r);
  }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    for (const auto& term : terms_) term.add_jacobian(state, J);
  }

  /// Stress scale: thermal stress due to the largest change of temperature.
  assembly::Scales loads(Real t) const override {
    Real change = spread_;
    const auto see = [&](const GivenTemperature& given, LocalIndex cell, const mesh::Vector& x) {
      const Real value = given.value(x, t);
      const Real here = given.per_rate > 0 ? given.per_rate * value : value - reference_[cell];
      if (std::isfinite(here)) change = std::max(change, std::abs(here));
    };
    for (const auto& given : parameters_.given) {
      const auto is_in = [&](LocalIndex cell) { return given.region < 0 || mesh_->cell_region[cell] == given.region; };
      if (given.boundary >= 0) {
        for (const auto& face : mesh_->boundary_faces)
          if (face.boundary == given.boundary && is_in(face.cell))
            see(given, face.cell, mesh::face_centre(mesh::face_corners(*mesh_, face.cell, face.local_face)));
      } else {
        for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c)
          if (is_in(c)) see(given, c, mesh::cell_centre(*mesh_, c));
      }
    }
    return {{"stress", largest_ * change}};
  }

 private:
  /// Returns 3 K alpha_T, Pa/K.
  Real stiffness(LocalIndex cell) const {
    const auto& law = parameters_.elasticity.of_cell(*mesh_, cell);
    return (3 * law.lambda + 2 * law.G) * parameters_.expansion.of_cell(*mesh_, cell);
  }
  Real initial(LocalIndex cell) const {
    if (parameters_.initial.is_constant()) return parameters_.initial({}, 0);
    return assembly::cell_mean(*mesh_, cell, [&](const auto& x) { return parameters_.initial(x, 0); })[1];
  }
  void find_sizes() {
    std::vector<Real> ends = {-std::numeric_limits<Real>::infinity(), -std::numeric_limits<Real>::infinity(), largest_};
    for (const Real T : reference_) ends = {std::max(ends[0], T), std::max(ends[1], -T), ends[2]};
    ends = base::max_over_ranks(*mesh_->comm, ends);
    spread_ = ends[0] + ends[1];
    largest_ = ends[2];
  }

  std::vector<Real> stresses(const assembly::State& state) const {
    const auto T = base::to_host(state.x[temperature_]);
    std::vector<Real> values;
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c) values.push_back(-stiffness(c) * (T(c) - reference_[c]));
    return values;
  }

  ThermalStressParameters parameters_;
  RCP<const mesh::Mesh> mesh_;
  int temperature_ = -1;
  std::vector<Real> reference_;  // [local cell] T_0, K
  Real largest_ = 0;             // largest 3 K alpha_T, Pa/K
  Real spread_ = 0;              // range of T_0, K
  std::vector<assembly::Term> terms_;
};

/// | symbol | shape           | unit     |                                      |
/// | x      | 1               | K        | T of the cell                        |
/// | r      | 1               | m^3/s    | -rate V beta (T - T_old)             |
/// | room   | [local cell]    | m^3/K    | V beta                               |
/// | saved   | [owned cell, 1] | K        | T_old                                |
struct Expansion {
  using Columns = assembly::Slots<Slot<1, 1>>;
  using Rows = Columns;
  ConstView<Real*> room;
  View<Real**> saved;
  Real rate = 0;

  KOKKOS_INLINE_FUNCTION void residual(int c, const Real (&x)[1], Real (&r)[1]) const {
    r[0] = c < static_cast<int>(saved.extent(0)) ? -room(c) * rate * (x[0] - saved(c, 0)) : 0;  // else a ghost
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int c, const Real (&)[1], Real (&J)[1][1]) const { J[0][0] = -room(c) * rate; }
};

class PoreExpansion final : public assembly::Module, public assembly::InitialValues, public assembly::Steps {
 public:
  explicit PoreExpansion(PoreExpansionParameters parameters) : parameters_(std::move(parameters)) {}

  std::string name() const override { return "thermal expansion in pores"; }

  assembly::Declaration declare(const mesh::Mesh&) const override {
    assembly::Declaration d;
    d.couplings = {{Loop::cells, "pressure", {"temperature"}}};
    d.stores = true;
    d.history = {{"temperature", fields::Entity::cell, 1}};
    return d;
  }

  void bind(const assembly::Context& context) override {
    temperature_ = context.field("temperature");
    assembler_ = std::make_unique<Assembler>(context, Loop::cells, std::vector{context.field("pressure")},
                                             std::vector{temperature_}, Assembler::Positions::keep);
    const auto& mesh = *context.mesh();
    std::vector<Real> room;
    for (LocalIndex c = 0; c < mesh.n_cells(); ++c) {
      const auto [volume, mean] =
          assembly::cell_mean(mesh, c, [&](const auto& x) { return parameters_.initial(x, 0); });
      room.push_back(volume * parameters_.expansion.of_cell(mesh, c));
      initial_.push_back(mean);
    }
    op_.room = assembly::to_device(room, "room");
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    assembler_->add_residual(at(state), state, r);
  }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    assembler_->add_jacobian(at(state), state, J);
  }

  void initial_history(const std::vector<View<Real**>>& history) const override {
    const base::HostTable<Real**> saved(history[0]);
    for (std::size_t c = 0; c < saved.extent(0); ++c) saved(c, 0) = initial_[c];
    saved.on_device();
  }
  void commit(assembly::State& state) const override {
    const auto saved = state.history[0];
    const auto T = state.x[temperature_];
    Kokkos::parallel_for(
        "keep", Kokkos::RangePolicy<Execution>(0, saved.extent(0)), KOKKOS_LAMBDA(int c) { saved(c, 0) = T(c); });
  }

 private:
  using Assembler = assembly::Assembler<Expansion>;

  Expansion at(const assembly::State& state) const {
    auto op = op_;
    op.saved = state.history[0];
    op.rate = state.rate;
    return op;
  }

  PoreExpansionParameters parameters_;
  int temperature_ = -1;
  std::vector<Real> initial_;  // [local cell]
  Expansion op_;
  std::unique_ptr<Assembler> assembler_;
};

}  // namespace

std::unique_ptr<assembly::Module> make_thermal_stress(ThermalStressParameters parameters) {
  return std::make_unique<ThermalStress>(std::move(parameters));
}

std::unique_ptr<assembly::Module> make_pore_expansion(PoreExpansionParameters parameters) {
  return std::make_unique<PoreExpansion>(std::move(parameters));
}

}  // namespace sprekk::physics
