#include "physics/poroelasticity/poroelastic_coupling.hpp"

#include "assembly/capabilities.hpp"
#include "assembly/geometry.hpp"
#include "assembly/saved_amounts.hpp"
#include "assembly/term.hpp"
#include "assembly/volume_work.hpp"
#include "mesh/extents.hpp"
#include "mesh/facets.hpp"
#include "physics/mechanics/displacements.hpp"
#include "transport/hybrid_diffusion.hpp"

namespace sprekk::physics {

using assembly::Loop;

namespace {

class PoroelasticCoupling final : public assembly::Module,
                                  public assembly::InitialValues,
                                  public assembly::Steps,
                                  public assembly::Transfer,
                                  public assembly::RowWeights,
                                  public assembly::ArtificialStorage,
                                  public assembly::Totals {
 public:
  explicit PoroelasticCoupling(PoroelasticCouplingParameters parameters) : parameters_(std::move(parameters)) {}

  std::string name() const override { return "poroelastic coupling"; }
  std::string fingerprint() const override { return parameters_.stabilisation.initial.text(); }

  assembly::Declaration declare(const mesh::Mesh& mesh) const override {
    assembly::Declaration d;
    const Real area = mesh::typical_face_area(mesh);
    for (const auto& part : assembly::divergence_fields(mesh, displacements)) {
      d.couplings.push_back({part.loop, part.field, {"pressure"}});
      d.couplings.push_back({part.loop, "pressure", {part.field}});
    }
    for (const char* row : {"pressure", "face pressure"}) {
      d.couplings.push_back({Loop::cells, row, {"pressure", "face pressure"}});
      d.sizes.push_back({row, {"displacement", area, true}});
    }
    d.relations = {{"stress", 1, "pressure"}, {"pressure", 1, "stress"}};
    d.schur = {"pressure"};
    d.stores = true;
    d.history = {{"volume", fields::Entity::cell, 1, true}, {"exchange", fields::Entity::facet, 1, true}};
    return d;
  }

  void bind(const assembly::Context& context) override;
  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    for (const auto& term : rates_) term.add_residual(state, r);
    assembly::subtract_saved(state, pressures_, r);
  }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override;
  void artificial(const assembly::State& state, const assembly::Rows& rows) const override {
    stabilisation_.add_residual(with_rate(state, 1), rows);
  }
  void add_schur(const assembly::State& state, const assembly::Rows& diagonal) const override {
    const auto rows = diagonal[pressures_[0]];
    const auto schur = schur_;
    const Real rate = state.rate;
    Kokkos::parallel_for(
        "schur", Kokkos::RangePolicy<Execution>(0, rows.extent(0)),
        KOKKOS_LAMBDA(int i) { rows(i) += rate * schur(i); });
  }

  void initial(const assembly::Rows& x) const override {
    transport::put_initial(*mesh_, parameters_.stabilisation.initial, x[pressures_[0]], x[pressures_[1]]);
  }

  /// Pore volume that the deformation adds.
  void totals(const assembly::State& state, std::vector<assembly::Total>& totals) const override {
    const auto unit = mesh_->dim() == 2 ? "m^2" : "m^3";
    totals.push_back({{"stored", name()}, assembly::sum_of_saved(state, pressures_), unit});
  }

  /// Updates the history in the present state, also in new cells.
  void take_over(assembly::State& state) const override { commit(state); }

  void commit(assembly::State& state) const override { assembly::save_amounts(state, pressures_, rates_, 0, 1); }
  /// The stabilising terms, whose sum over cells and facets is zero, follow the pressures.
  void to_conserved(assembly::State& state) const override {
    assembly::save_amounts(state, pressures_, {stabilisation_}, 1, -1);
  }
  void from_conserved(assembly::State& state) const override {
    assembly::save_amounts(state, pressures_, {stabilisation_}, 1, 1);
  }

 private:
  static assembly::State with_rate(assembly::State state, Real rate) {
    state.rate = rate;
    return state;
  }

  Real initial(const mesh::Vector& x) const { return parameters_.stabilisation.initial(x, 0); }
  Real mean_initial(LocalIndex cell) const {
    return assembly::cell_mean(*mesh_, cell, [&](const auto& x) { return initial(x); })[1];
  }
  Real biot(LocalIndex cell) const { return parameters_.biot.of_cell(*mesh_, cell); }

  void add_stabilisation(const assembly::Context& context);

  PoroelasticCouplingParameters parameters_;
  RCP<const mesh::Mesh> mesh_;
  std::vector<int> pressures_{};       // blocks of pressure, face pressure
  ConstView<Real*> schur_;             // [owned cell] alpha^2 V/(lambda + 2G), m^3/Pa: Schur complement (fixed stress)
  std::vector<assembly::Term> rates_;  // proportional to the rate of the state
  assembly::Term stabilisation_;       // contained in rates_
};

void PoroelasticCoupling::bind(const assembly::Context& context) {
  mesh_ = context.mesh();
  pressures_ = {context.field("pressure"), context.field("face pressure")};
  std::vector<Real> schur;
  for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c)
    schur.push_back(parameters_.stabilisation.softness[c] *
                    assembly::cell_mean(*mesh_, c, [](const auto&) { return 0; })[0]);
  schur_ = assembly::to_device(schur, "schur");
  for (const auto& part : assembly::divergence(*mesh_, displacements, [this](LocalIndex c) { return biot(c); })) {
    std::vector<Real> reference;
    for (const LocalIndex cell : part.cells) reference.push_back(mean_initial(cell));
    rates_.push_back(assembly::make_volume_work(context,
                                                {part.loop, context.field(part.field), pressures_[0], part.volume,
                                                 assembly::to_device(reference, "initial pressure")},
                                                true));
    if (part.loop == Loop::cells) add_stabilisation(context);
  }
}

void PoroelasticCoupling::jacobian(const assembly::State& state, fields::BlockMatrix& J) const {
  for (const auto& term : rates_) term.add_jacobian(state, J);
}

void PoroelasticCoupling::add_stabilisation(const assembly::Context& context) {
  stabilisation_ = mesh::for_corners(mesh_->shape, [&](auto shape) {
    return assembly::Term(
        context, Loop::cells, pressures_, pressures_, true,
        [op = transport::stabilising_flow<shape()>(*mesh_, parameters_.stabilisation)](const assembly::State& state) {
          auto at = op;
          at.rate = state.rate;
          return at;
        });
  });
  rates_.push_back(stabilisation_);
}

}  // namespace

std::unique_ptr<assembly::Module> make_poroelastic_coupling(PoroelasticCouplingParameters parameters) {
  return std::make_unique<PoroelasticCoupling>(std::move(parameters));
}

}  // namespace sprekk::physics
