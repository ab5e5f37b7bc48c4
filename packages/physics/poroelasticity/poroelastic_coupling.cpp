#include "physics/poroelasticity/poroelastic_coupling.hpp"

#include "assembly/capabilities.hpp"
#include "assembly/geometry.hpp"
#include "assembly/term.hpp"
#include "assembly/volume_work.hpp"
#include "mesh/extents.hpp"
#include "mesh/facets.hpp"
#include "physics/mechanics/displacements.hpp"
#include "transport/hybrid_diffusion.hpp"

namespace sprekk::physics {

using assembly::Loop;
using assembly::Slot;

namespace {

/// Fluid pressure on one side of a fracture face, and the contribution of this side to the widening of the face.
///
/// | symbol    | shape                       | unit     |                                                     |
/// | x         | displacements [m], p, b     | m, Pa, m | unknowns                                            |
/// | r         | forces [m], row of b        | N, m^3 (2D: m^2) | -p dW/du, share |f| b - W                   |
/// | volume    | [entity, m]                 | m^2      | dW/du                                               |
/// | part      | [entity]                    | m^2      | share |f|                                           |
template <class... Displacements>
struct Opening {
  using Columns = assembly::Slots<Displacements..., Slot<1, 1>, Slot<1, 1>>;
  using Rows = assembly::Slots<Displacements..., Slot<1, 1>>;
  static constexpr int m = Rows::size - 1, last = sizeof...(Displacements);
  static constexpr bool couples(int row, int column) { return (row == last) != (column == last); }
  View<Real**> volume;
  ConstView<Real*> part;

  KOKKOS_INLINE_FUNCTION void residual(int e, const Real (&x)[m + 2], Real (&r)[m + 1]) const {
    r[m] = part(e) * x[m + 1];
    for (int k = 0; k < m; ++k) {
      r[k] = -volume(e, k) * x[m];
      r[m] -= volume(e, k) * x[k];
    }
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int e, const Real (&)[m + 2], Real (&J)[m + 1][m + 2]) const {
    for (auto& row : J)
      for (Real& value : row) value = 0;
    J[m][m + 1] = part(e);
    for (int k = 0; k < m; ++k) J[k][m] = J[m][k] = -volume(e, k);
  }
};

class PoroelasticCoupling final : public assembly::Module,
                                  public assembly::InitialValues,
                                  public assembly::Steps,
                                  public assembly::Transfer,
                                  public assembly::RowWeights,
                                  public assembly::ArtificialStorage {
 public:
  PoroelasticCoupling(const mesh::Mesh& mesh, PoroelasticCouplingParameters parameters)
      : parameters_(std::move(parameters)),
        fractures_(!mesh.fracture_names.empty()),
        tips_(mesh.n_global_enriched > 0) {}

  std::string name() const override { return "poroelastic coupling"; }
  std::string fingerprint() const override { return parameters_.stabilisation.initial.text(); }

  assembly::Declaration declare(const mesh::Mesh& mesh) const override {
    assembly::Declaration d;
    const Real area = mesh::typical_face_area(mesh);
    for (const auto& part : assembly::divergence_fields(mesh, displacements)) {
      d.couplings.push_back({part.loop, part.field, {"pressure"}});
      d.couplings.push_back({part.loop, "pressure", {part.field}});
    }
    const auto open = [&](Loop loop, const char* displacement) {
      d.couplings.push_back({loop, displacement, {"face pressure"}});
      d.couplings.push_back({loop, "widening", {displacement, "widening"}});
    };
    if (fractures_) {
      assembly::Unknown widening{
          {"widening", fields::Entity::fracture_face, 1, "m"}, "displacement", {{"displacement", area}}};
      widening.local_group = "fracture face";
      d.unknowns = {widening};
      open(Loop::fracture_sides, "displacement");
      open(Loop::fracture_sides, "side bubble");
    }
    if (tips_) open(Loop::tip_sides, "tip displacement");
    for (const char* row : {"pressure", "face pressure"}) {
      d.couplings.push_back({Loop::cells, row, {"pressure", "face pressure"}});
      d.sizes.push_back({row, {"displacement", area, true}});
    }
    d.relations = {{"stress", 1, "pressure"}, {"pressure", 1, "stress"}};
    d.schur = {"pressure"};
    d.stores = true;
    d.history = {{"volume", fields::Entity::cell, 1}, {"exchange", fields::Entity::facet, 1}};
    return d;
  }

  void bind(const assembly::Context& context) override;
  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    for (const auto& term : rates_) term.add_residual(state, r);
    for (const auto& term : openings_) term.add_residual(state, r);
    for (int k = 0; k < 2; ++k) {
      const auto rows = r[pressures_[k]];
      const auto old = state.history[k];
      const Real rate = state.rate;
      Kokkos::parallel_for(
          "old", Kokkos::RangePolicy<Execution>(0, rows.extent(0)),
          KOKKOS_LAMBDA(int i) { rows(i) -= rate * old(i, 0); });
    }
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

  /// Updates the history in the present state, also in new cells.
  void take_over(assembly::State& state) const override { commit(state); }

  /// Saves the storage terms of pressure rows, multiplied by dt.
  void commit(assembly::State& state) const override {
    assembly::Rows volumes;
    for (const auto& x : state.x) volumes.emplace_back("volumes", x.extent(0));
    const auto at_rate_1 = with_rate(state, 1);
    for (const auto& term : rates_) term.add_residual(at_rate_1, volumes);
    for (int k = 0; k < 2; ++k) {
      const auto saved = state.history[k];
      const auto now = volumes[pressures_[k]];
      Kokkos::parallel_for(
          "keep", Kokkos::RangePolicy<Execution>(0, saved.extent(0)), KOKKOS_LAMBDA(int i) { saved(i, 0) = now(i); });
    }
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
  void add_sides(const assembly::Context& context);
  void add_tips(const assembly::Context& context);

  PoroelasticCouplingParameters parameters_;
  bool fractures_, tips_;  // the mesh has fractures; enriched tips
  RCP<const mesh::Mesh> mesh_;
  std::array<int, 2> pressures_{};  // blocks of pressure, face pressure
  ConstView<Real*> schur_;          // [owned cell] alpha^2 V/(lambda + 2G), m^3/Pa: Schur complement (fixed stress)
  std::vector<assembly::Term> rates_, openings_;  // rates_ are proportional to the rate of the state
  assembly::Term stabilisation_;                  // contained in rates_
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
  if (fractures_) add_sides(context);
  if (tips_) add_tips(context);
}

void PoroelasticCoupling::jacobian(const assembly::State& state, fields::BlockMatrix& J) const {
  for (const auto& term : rates_) term.add_jacobian(state, J);
  for (const auto& term : openings_) term.add_jacobian(state, J);
}

void PoroelasticCoupling::add_stabilisation(const assembly::Context& context) {
  const std::vector<int> blocks(pressures_.begin(), pressures_.end());
  stabilisation_ = mesh::for_corners(mesh_->shape, [&](auto shape) {
    return assembly::Term(
        context, Loop::cells, blocks, blocks, true,
        [op = transport::stabilising_flow<shape()>(*mesh_, parameters_.stabilisation)](const assembly::State& state) {
          auto at = op;
          at.rate = state.rate;
          return at;
        });
  });
  rates_.push_back(stabilisation_);
}

void PoroelasticCoupling::add_sides(const assembly::Context& context) {
  const int u = context.field("displacement"), beta = context.field("side bubble"), b = context.field("widening");
  std::vector<Real> halves;
  for (const auto& [f, side] : assembly::fracture_sides(*mesh_)) halves.push_back(mesh_->fracture_faces[f].area / 2);
  openings_.push_back(mesh::for_shape(mesh_->shape, [&](auto shape) {
    constexpr int dim = mesh::dimension(shape());
    const Opening<Slot<mesh::n_nodes(shape()), dim>, Slot<1, dim>> op{assembly::side_volumes(*mesh_),
                                                                      assembly::to_device(halves, "half of the area")};
    return assembly::Term(context, Loop::fracture_sides, {u, beta, b}, {u, beta, pressures_[1], b}, true,
                          [op](const assembly::State&) { return op; });
  }));
}

void PoroelasticCoupling::add_tips(const assembly::Context& context) {
  const int q = context.field("tip displacement"), b = context.field("widening");
  const auto of_sides = assembly::tip_side_volumes(*mesh_);
  const auto part = assembly::to_device(std::vector<Real>(of_sides.extent(0), 0), "none of the area");
  openings_.push_back(mesh::for_corners(mesh_->shape, [&](auto shape) {
    const Opening<Slot<mesh::n_nodes(shape()), mesh::dimension(shape())>> op{of_sides, part};
    return assembly::Term(context, Loop::tip_sides, {q, b}, {q, pressures_[1], b}, true,
                          [op](const assembly::State&) { return op; });
  }));
}

}  // namespace

std::unique_ptr<assembly::Module> make_poroelastic_coupling(const mesh::Mesh& mesh,
                                                            PoroelasticCouplingParameters parameters) {
  return std::make_unique<PoroelasticCoupling>(mesh, std::move(parameters));
}

}  // namespace sprekk::physics
