#include "physics/tracer/rock_tracer.hpp"

#include "assembly/capabilities.hpp"
#include "assembly/term.hpp"

namespace sprekk::physics {

namespace {

/// | x    | 1            | kg/m^3 | c of the cell                      |
/// | r    | 1            | kg/s   | (2D: kg/(m s))                     |
/// | sink | [local cell] | m^3/s  | decay constant, times V R porosity |
struct CellDecay {
  using Columns = assembly::Slots<assembly::Slot<1, 1>>;
  using Rows = Columns;
  ConstView<Real*> sink;
  KOKKOS_INLINE_FUNCTION void residual(int cell, const Real (&x)[1], Real (&r)[1]) const { r[0] = sink(cell) * x[0]; }
  KOKKOS_INLINE_FUNCTION void jacobian(int cell, const Real (&)[1], Real (&J)[1][1]) const { J[0][0] = sink(cell); }
};

class RockTracer final : public assembly::Module, public assembly::Totals {
 public:
  RockTracer(std::vector<Real> capacity, Real decay) : room_(std::move(capacity)), decay_(decay) {}

  std::string name() const override { return "tracer in rock"; }

  assembly::Declaration declare(const mesh::Mesh&) const override {
    assembly::Declaration d;
    d.couplings = {{assembly::Loop::cells, "concentration", {"concentration"}}};
    d.linear = true;
    return d;
  }

  void bind(const assembly::Context& context) override {
    mesh_ = context.mesh();
    block_ = context.field("concentration");
    const auto volumes = assembly::cell_volumes(*mesh_);
    std::vector<Real> sink;
    for (LocalIndex c = 0; c < mesh_->n_cells(); ++c) {
      room_[c] *= volumes[c];
      sink.push_back(decay_ * room_[c]);
    }
    const CellDecay op{assembly::to_device(sink, "sink")};
    term_ = assembly::Term(context, assembly::Loop::cells, {block_}, {block_}, false, [op](const auto&) { return op; });
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override { term_.add_residual(state, r); }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override { term_.add_jacobian(state, J); }

  void totals(const assembly::State& state, std::vector<assembly::Total>& totals) const override {
    const auto c = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), state.x[block_]);
    Real mass = 0;
    for (LocalIndex cell = 0; cell < mesh_->n_owned_cells; ++cell) mass += room_[cell] * c(cell);
    add_tracer_totals(*mesh_, "in rock", mass, decay_ * mass, totals);
  }

 private:
  std::vector<Real> room_;  // [local cell] V R porosity; before bind() R porosity
  Real decay_;
  RCP<const mesh::Mesh> mesh_;
  int block_ = -1;
  assembly::Term term_;
};

}  // namespace

std::unique_ptr<assembly::Module> make_rock_tracer(std::vector<Real> capacity, Real decay) {
  return std::make_unique<RockTracer>(std::move(capacity), decay);
}

void add_tracer_totals(const mesh::Mesh& mesh, const std::string& place, Real mass, Real decay,
                       std::vector<assembly::Total>& totals) {
  const bool flat = mesh.dim() == 2;
  totals.push_back({{"tracer", place}, mass, flat ? "kg/m" : "kg"});
  totals.push_back({{"tracer", "decay"}, decay, flat ? "kg/(m*s)" : "kg/s"});
}

}  // namespace sprekk::physics
