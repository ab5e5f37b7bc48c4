#include "transport/balance_error.hpp"

#include "assembly/geometry.hpp"
#include "base/check.hpp"
#include "base/host_table.hpp"
#include "base/names.hpp"
#include "base/over_ranks.hpp"
#include "estimate/step_rates.hpp"
#include "transport/flux_truncation.hpp"
#include "transport/present_conduits.hpp"
#include "transport/well_connections.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace sprekk::transport {

namespace {

int block_of(const assembly::System& system, const std::string& name) {
  const auto& blocks = system.blocks();
  const auto found = std::find_if(blocks.begin(), blocks.end(), [&](const auto& b) { return b.name == name; });
  return found == blocks.end() ? -1 : static_cast<int>(found - blocks.begin());
}

/// Block numbers of the unknowns on cells and on facets.
using Blocks = std::array<int, 2>;
Blocks blocks_of(const assembly::System& system, const std::string& field) {
  return {block_of(system, field), block_of(system, "face " + field)};
}

std::unique_ptr<FluxTruncation> truncation_of(const assembly::System& system, const Blocks& blocks,
                                              HybridFluxParameters parameters) {
  const auto& layouts = system.layouts();
  return make_flux_truncation(Teuchos::rcpFromRef(system.mesh()), layouts[blocks[0]], layouts[blocks[1]],
                              system.constrained(blocks[1]), std::move(parameters));
}

/// Transmissivities of fractures with the apertures at x; none: the system has no field "widening". Collective.
std::optional<FaceTransmissivity> transmissivities(const assembly::System& system,
                                                   const std::vector<laws::Conduit>& conduits,
                                                   const fields::BlockVector& x) {
  const int block = block_of(system, "widening");
  if (block < 0) return std::nullopt;
  const auto local = [&](int of) {
    const auto& layout = system.layouts()[of];
    fields::Vector all(layout.ghosted());
    all.doImport(*x[of], *layout.import(), Tpetra::REPLACE);
    const auto values = all.getLocalViewHost(Tpetra::Access::ReadOnly);
    return std::vector<Real>(values.data(), values.data() + values.extent(0));
  };
  const auto widening = local(block), p = local(block_of(system, "face pressure"));
  const auto& facets = *system.mesh().facets;
  FaceTransmissivity all;
  mesh::for_face_corners(system.mesh().shape, [&](auto shape) {
    constexpr int n = mesh::n_face_corners(shape());
    for (std::size_t f = 0; f < conduits.size(); ++f) {
      Real rise[n];
      for (int k = 0; k < n; ++k) rise[k] = p[facets.ridge[f * n + k]] - p[facets.fracture_face[f]];
      all.of_faces.push_back(conduits[f].transmissivity(widening[f]));
      for (const Real t : EndTransmissivities<n>(conduits[f], widening[f], rise).value)
        all.at_ridges.push_back(t / all.of_faces.back());
    }
  });
  return all;
}

class BalanceError final : public estimate::MeshError, estimate::GoalErrors {
 public:
  BalanceError(assembly::System& system, BalanceErrorParameters parameters)
      : system_(system),
        parameters_(std::move(parameters)),
        blocks_(blocks_of(system, parameters_.field)),
        names_{.name = parameters_.flux,
               .unit = parameters_.power,
               .density = parameters_.flux + " error density",
               .is_balance = true},
        rates_(parameters_.start) {
    const auto& mesh = system.mesh();
    auto& error = parameters_.error;
    const auto& wells = parameters_.wells;
    if (!wells.wells.empty()) connections_ = find_well_connections(mesh, wells).all;
    index_of_wells_.resize(wells.wells.size());
    for (auto& c : connections_) {
      if (c.face >= 0) c.index *= wells.faces[c.face].transmissivity();
      index_of_wells_[c.well] += c.index;
      if (c.face < 0 || mesh.dim() == 3) continue;
      const Real distance = distance_along(c);
      Real& maximum = error.flow.fed[c.face];  // largest distance among the wells of a face
      if (std::abs(distance) > std::abs(maximum)) maximum = distance;
    }
    index_of_wells_ = base::sum_over_ranks(*mesh.comm, index_of_wells_);
    for (const auto& one : error.flow.constrained) conditions_[one.name] = one.boundary;
    truncation_ = truncation_of(system, blocks_, error.flow);
    const auto& layouts = system.layouts();
    error_ = make_hybrid_error(Teuchos::rcpFromRef(mesh), layouts[blocks_[0]], layouts[blocks_[1]],
                               system.constrained(blocks_[1]), error);
    if (parameters_.carrier) {
      carriers_ = blocks_of(system, "pressure");
      carrier_ = truncation_of(system, carriers_, parameters_.carrier->flow);
    }
    find_cells_at_wells();
  }

  const Names& names() const override { return names_; }
  estimate::GoalErrors* goals() override { return this; }

  estimate::StateError of_state(const fields::BlockVector& x, Real t) override {
    const auto& conduits = parameters_.conduits;
    if (const auto T = conduits ? transmissivities(system_, *conduits, x) : std::nullopt) {
      error_->set_transmissivity(*T);
      truncation_->set_transmissivity(*T);
    }
    const auto rates = rates_.to(t, system_.rates());
    auto parts = without_wells(error_->of_state(*x[blocks_[0]], *x[blocks_[1]], t, rates));
    std::array<Real, 2> sums{};
    for (std::size_t k = 0; k < error_->n_of_energy(); ++k) {
      sums[0] += parts.error[k] * parts.error[k];
      sums[1] += parts.whole[k] * parts.whole[k];
    }
    sums = base::sum_over_ranks(*system_.mesh().comm, sums);
    estimate::StateError result{by_cell(parts.error)};
    result.density = result.energy;
    for (std::size_t c = 0; c < result.density.size(); ++c)
      result.density[c] /=
          assembly::cell_mean(system_.mesh(), static_cast<LocalIndex>(c), [](const auto&) { return 1; })[0];
    result.error = std::sqrt(sums[0]);
    result.whole = std::sqrt(sums[1]);
    result.relative = result.whole > 0 ? result.error / result.whole : 0;
    of_state_ = std::move(parts.error);
    return result;
  }
  estimate::CellErrors of_adjoint(const fields::BlockVector& x, const fields::BlockVector& z) override {
    const auto [cells, facets] = blocks_;
    return by_cell(without_wells(error_->of_linearized(*x[cells], *x[facets], *z[cells], *z[facets])).error);
  }

  void add_residual(const fields::BlockVector& x, fields::BlockVector& right_side) override {
    const auto forces = error_->forces(of_state_);
    auto& of_facets = *right_side[blocks_[1]];
    truncation_->add_to_rows(truncation_->flows(forces.on_flows), *right_side[blocks_[0]], of_facets);
    truncation_->add_over_ranks(forces.on_facets, of_facets);
    {
      const auto of_cells = right_side[blocks_[0]]->getLocalViewHost(Tpetra::Access::ReadWrite);
      for (std::size_t c = 0; c < forces.on_cells.size(); ++c) of_cells(c, 0) += forces.on_cells[c];
    }
    if (!carrier_) return;
    if (const auto T = transmissivities(system_, parameters_.carrier->conduits, x)) carrier_->set_transmissivity(*T);
    carried_ = {std::vector<Real>(forces.on_flows.in_cells.size(), 0),
                std::vector<Real>(forces.on_flows.in_faces.size(), 0)};
    truncation_->add_upwind(carrier_->flows(*x[carriers_[0]], *x[carriers_[1]]), parameters_.carrier->capacity,
                            *x[blocks_[0]], *x[blocks_[1]], carried_);
    truncation_->add_to_rows(carried_, *right_side[blocks_[0]], of_facets);
  }
  void add_prescribed(Real t, fields::BlockVector& right_side) const override {
    truncation_->add_prescribed(t, *right_side[blocks_[1]]);
  }
  std::vector<Real> carried(const fields::BlockVector& dx) const override {
    return carrier_ ? truncation_->products(carried_, *dx[blocks_[0]], *dx[blocks_[1]])
                    : std::vector<Real>(system_.mesh().n_owned_cells, 0);
  }

  bool knows(const std::string& what) const override {
    return what == parameters_.potential.what || what == parameters_.flow.what;
  }

  estimate::Estimate evaluate(const estimate::Functional& J, const estimate::State& state,
                              const estimate::Correction* correction) override {
    auto reactions = system_.reactions(state.x);
    const Real now = value(J, state.x, reactions);
    if (!correction) return {now, std::numeric_limits<Real>::infinity()};
    for (std::size_t k = 0; k < reactions.size(); ++k)
      for (std::size_t i = 0; i < reactions[k].force.size(); ++i)
        reactions[k].force[i] += correction->reactions[k].force[i];
    auto x = fields::create_like(state.x);
    fields::copy(state.x, x);
    for (std::size_t b = 0; b < x.size(); ++b) x[b]->update(1, *correction->dx[b], 1);
    return {now, value(J, x, reactions) - now};
  }

  bool add_derivative(const estimate::Functional& J, const estimate::State&, fields::BlockVector& right_side) override {
    const auto at = [&](int k) { return right_side[blocks_[k]]->getLocalViewHost(Tpetra::Access::ReadWrite); };
    const std::array rows = {at(0), at(1)};
    if (!J.well.empty()) {
      add_well(J, rows);
    } else if (is_flow(J)) {
      add_boundary(J.boundary, rows[1]);
    } else {
      const auto faces = faces_of(J);
      const Real area = area_of(faces);
      const auto& mesh = system_.mesh();
      for (const LocalIndex f : faces) rows[1](mesh.facets->fracture_face[f], 0) += mesh.fracture_faces[f].area / area;
    }
    return true;
  }

 private:
  bool is_flow(const estimate::Functional& J) const { return J.what == parameters_.flow.what; }

  estimate::CellErrors by_cell(const std::vector<Real>& components) const {
    const auto& cells = error_->cells();
    estimate::CellErrors result{std::vector<Real>(system_.mesh().n_owned_cells, 0)};
    for (std::size_t k = 0; k < components.size(); ++k)
      if (k < error_->n_of_energy())
        result.energy[cells[k]] += components[k] * components[k];
      else
        result.components.push_back({cells[k], components[k]});
    return result;
  }

  /// Value of J at x. `reactions`: those of System::reactions().
  Real value(const estimate::Functional& J, const fields::BlockVector& x,
             const std::vector<assembly::Reaction>& reactions) {
    for (const auto& well : parameters_.wells.wells)
      SPREKK_CHECK(
          !in_rock_.count(well.name),
          "Sprekk > Flow > Wells > {} > \"points\": in rock, must be on a fracture with \"Accuracy\": finer cells "
          "do not make its pressure more accurate, and are soon smaller than its radius",
          well.name);
    if (!J.well.empty())
      return total({"wells", J.well, (is_flow(J) ? parameters_.flow : parameters_.potential).of_well}, x);
    return is_flow(J) ? through(J.boundary, x, reactions) : mean(J, x);
  }

  /// Signed distance of a well from the centre of its fracture face, along the face, m.
  Real distance_along(const WellConnection& c) const {
    const auto& face = system_.mesh().fracture_faces[c.face];
    const auto& x = parameters_.wells.wells[c.well].points[0];
    return mesh::dot(mesh::operator-(x, face.centre), face.frame[1]);
  }
  void find_cells_at_wells() {
    const auto& mesh = system_.mesh();
    const int n = mesh.nodes_per_cell();
    std::vector<GlobalIndex> nodes;
    for (const auto& c : connections_)
      for (int k = 0; k < n && c.face < 0; ++k) nodes.push_back(mesh.node_id[mesh.cells[c.row * n + k]]);
    nodes = base::gather_over_ranks(*mesh.comm, nodes);
    std::vector<int> in_rock(parameters_.wells.wells.size(), 0);
    for (const auto& c : connections_)
      if (c.face < 0) in_rock[c.well] = 1;
    in_rock = base::max_over_ranks(*mesh.comm, in_rock);
    for (std::size_t w = 0; w < in_rock.size(); ++w)
      if (in_rock[w]) in_rock_.insert(parameters_.wells.wells[w].name);
    const std::set<GlobalIndex> at_wells(nodes.begin(), nodes.end());
    is_at_well_.resize(mesh.n_owned_cells, 0);
    for (LocalIndex k = 0; k < mesh.n_owned_cells * n; ++k)
      if (at_wells.count(mesh.node_id[mesh.cells[k]])) is_at_well_[k / n] = 1;
  }
  HybridError::Parts without_wells(HybridError::Parts parts) const {
    for (std::size_t k = 0; k < parts.error.size(); ++k)
      if (is_at_well_[error_->cells()[k]]) parts.error[k] = 0;
    return parts;
  }

  Real total(const std::vector<std::string>& names, const fields::BlockVector& x) {
    Real sum = 0;
    for (const auto& one : system_.totals(x))
      if (one.names == names) sum += one.value;
    return sum;
  }
  /// Inflow into the domain through prescribed conditions of a boundary.
  Real through(const std::string& boundary, const fields::BlockVector& x,
               const std::vector<assembly::Reaction>& reactions) {
    const auto number = base::index_of(system_.mesh().boundary_names, boundary);
    Real sum = total({parameters_.inflows, boundary}, x);
    for (const auto& reaction : reactions)
      if (reaction.called.name == parameters_.inflows && reaction.field == "face " + parameters_.field &&
          reaction.region < 0 && conditions_.at(reaction.condition) == number)
        sum += reaction.force[0];
    return sum;
  }

  std::vector<LocalIndex> faces_of(const estimate::Functional& J) const {
    const auto& mesh = system_.mesh();
    std::vector<LocalIndex> faces;
    for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
      const auto& name = mesh.fracture_names[mesh.fracture_faces[f].fracture];
      if (J.fractures.empty() || std::find(J.fractures.begin(), J.fractures.end(), name) != J.fractures.end())
        faces.push_back(f);
    }
    return faces;
  }
  Real area_of(const std::vector<LocalIndex>& faces) const {
    Real sum = 0;
    for (const LocalIndex f : faces) sum += system_.mesh().fracture_faces[f].area;
    return base::sum_over_ranks(*system_.mesh().comm, sum);
  }
  Real mean(const estimate::Functional& J, const fields::BlockVector& x) const {
    const auto& mesh = system_.mesh();
    const auto p = x[blocks_[1]]->getLocalViewHost(Tpetra::Access::ReadOnly);
    const auto faces = faces_of(J);
    Real sum = 0;
    for (const LocalIndex f : faces) sum += mesh.fracture_faces[f].area * p(mesh.facets->fracture_face[f], 0);
    return base::sum_over_ranks(*mesh.comm, sum) / area_of(faces);
  }

  /// Adds the derivative of a well functional. The flow W (p_w - p) is differentiated by p_w. The pressure of a well is
  /// the mean weighted by W.
  template <class Rows>
  void add_well(const estimate::Functional& J, const std::array<Rows, 2>& rows) const {
    for (const auto& c : connections_)
      if (parameters_.wells.wells[c.well].name == J.well)
        rows[c.face >= 0](c.row, 0) += is_flow(J) ? c.index : c.index / index_of_wells_[c.well];
  }
  /// Adds the derivative of a boundary flow with respect to the prescribed pressure.
  template <class Rows>
  void add_boundary(const std::string& boundary, const Rows& rows) const {
    const auto& mesh = system_.mesh();
    const auto& facets = *mesh.facets;
    const auto constrained = base::to_host(system_.constrained(blocks_[1]));
    const int number = base::index_of(mesh.boundary_names, boundary);
    const auto set = [&](LocalIndex facet) {
      if (facet < facets.n_owned && constrained(facet)) rows(facet, 0) = 1;
    };
    for (const auto& face : mesh.boundary_faces)
      if (face.boundary == number) set(facets.of_cell[face.cell * mesh::n_faces(mesh.shape) + face.local_face]);
    for (const auto& rim : facets.rims)
      if (rim.boundary == number) set(facets.ridge[rim.face * mesh::n_face_corners(mesh.shape) + rim.ridge]);
  }

  assembly::System& system_;
  BalanceErrorParameters parameters_;
  Blocks blocks_, carriers_{};
  Names names_;
  estimate::StepRates rates_;
  std::vector<Real> of_state_;  // components of the last state of of_state()
  std::vector<WellConnection> connections_;
  std::vector<Real> index_of_wells_;       // sum of W over all ranks
  std::vector<char> is_at_well_;           // [owned cell]
  std::set<std::string> in_rock_;          // names of wells in rock
  std::map<std::string, int> conditions_;  // [condition] boundary; conditions with prescribed pressure
  std::unique_ptr<HybridError> error_;
  std::unique_ptr<FluxTruncation> truncation_, carrier_;  // of the balance; of the carrier (null: none)
  HybridFlows carried_;                                   // excess transport in the last state
};

}  // namespace

std::unique_ptr<estimate::MeshError> make_balance_error(assembly::System& system, BalanceErrorParameters parameters) {
  return std::make_unique<BalanceError>(system, std::move(parameters));
}

}  // namespace sprekk::transport
