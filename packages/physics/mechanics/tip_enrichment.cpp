#include "physics/mechanics/tip_enrichment.hpp"

#include "assembly/assembler.hpp"
#include "assembly/capabilities.hpp"
#include "assembly/load.hpp"
#include "assembly/tip_cell.hpp"
#include "base/host_table.hpp"
#include "mesh/extents.hpp"
#include "physics/mechanics/balanced_side.hpp"

#include <algorithm>

namespace sprekk::physics {

using assembly::Loop;
using mesh::Shape;

namespace {

/// Elastic coupling of the nodal and tip displacements in one cell with a tip.
///
/// | symbol  | shape                       | unit |                                              |
/// | x, r    | u [node, dim], q [node, dim] | m, N | unknowns, forces                             |
/// | mixed   | [cell, node dim, node dim]  | N/m  | integral sigma(psi_b e_j) : grad(N_a e_i)    |
/// | own     | [cell, node dim, node dim]  | N/m  | integral sigma(psi_b e_j) : grad(psi_a e_i)  |
template <Shape shape>
struct EnrichedCell {
  using Cell = assembly::ReferenceCell<shape>;
  static constexpr int dim = Cell::dim, n = Cell::n_nodes, q = n * dim;  // q: offset in x
  using Columns = assembly::Slots<assembly::Slot<n, dim>, assembly::Slot<n, dim>>;
  using Rows = Columns;
  static constexpr bool couples(int row, int column) { return row > 0 || column > 0; }

  View<Real***> mixed, own;

  KOKKOS_INLINE_FUNCTION void residual(int cell, const Real (&x)[2 * q], Real (&r)[2 * q]) const {
    for (int i = 0; i < q; ++i) r[i] = r[q + i] = 0;
    for (int i = 0; i < q; ++i)
      for (int j = 0; j < q; ++j) {
        r[i] += mixed(cell, i, j) * x[q + j];
        r[q + j] += mixed(cell, i, j) * x[i];
        r[q + i] += own(cell, i, j) * x[q + j];
      }
  }

  KOKKOS_INLINE_FUNCTION void jacobian(int cell, const Real (&)[2 * q], Real (&J)[2 * q][2 * q]) const {
    for (int i = 0; i < q; ++i)
      for (int j = 0; j < q; ++j) {
        J[i][j] = 0;
        J[i][q + j] = J[q + j][i] = mixed(cell, i, j);
        J[q + i][q + j] = own(cell, i, j);
      }
  }
};

template <Shape shape>
class TipEnrichment final : public assembly::Module, public assembly::Loads {
 public:
  using Tip = assembly::TipCell<shape>;
  static constexpr int dim = Tip::dim, n = Tip::n;

  TipEnrichment(BulkMomentumParameters parameters, FluidPressure fluid)
      : parameters_(std::move(parameters)), fluid_(std::move(fluid)) {}

  std::string name() const override { return "tip enrichment"; }

  assembly::Declaration declare(const mesh::Mesh& mesh) const override {
    assembly::Declaration d;
    assembly::Unknown q{{"tip displacement", fields::Entity::enriched_node, dim, "m"},
                        "displacement",
                        {{"stress", mesh::typical_face_area(mesh)}}};
    q.enriches = "displacement";
    d.unknowns = {q};
    d.couplings = {{Loop::tip_cells, "displacement", {"tip displacement"}},
                   {Loop::tip_cells, "tip displacement", {"displacement", "tip displacement"}},
                   {Loop::tip_sides, "tip displacement", {"side bubble", "traction"}},
                   {Loop::tip_sides, "side bubble", {"tip displacement"}}};
    d.linear = true;
    d.outputs = {{{"tip displacement", "m", fields::Entity::node, dim}, [this](const auto& s) { return shown(s); }}};
    return d;
  }

  void bind(const assembly::Context& context) override {
    mesh_ = context.mesh();
    cell_of_ = assembly::tip_cells(*mesh_);
    const int u = context.field("displacement"), beta = context.field("side bubble"),
              lambda = context.field("traction");
    q_ = context.field("tip displacement");
    using Fields = std::vector<int>;
    cells_ = std::make_unique<Cells>(context, Loop::tip_cells, Fields{u, q_}, Fields{u, q_}, Cells::Positions::once);
    sides_ = std::make_unique<Sides>(context, Loop::tip_sides, Fields{q_, beta}, Fields{q_, beta, lambda},
                                     Sides::Positions::once);
    load_ = assembly::Load(context.layout(q_).n_owned());
    build_cells();
    build_sides();
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    cells_->add_residual(cell_, state, r);
    sides_->add_residual(side_, state, r);
    load_.add_to(r[q_], -1);
  }

  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    cells_->add_jacobian(cell_, state, J);
    sides_->add_jacobian(side_, state, J);
  }

  bool constant_load() const override {
    const auto& all = parameters_.tractions;
    return parameters_.body_force.constant_in_time() && fluid_.constant_in_time() &&
           std::all_of(all.begin(), all.end(), [](const auto& traction) { return traction.constant_in_time(); });
  }

  void set_time(Real t, const assembly::Scales&) override {
    if (loaded_ && constant_load()) return;
    load_.set([&](const auto& rows) {
      for (LocalIndex cell : cell_of_) add_volume_loads(cell, t, rows);
      for (const auto& face : mesh_->boundary_faces)
        if (assembly::has_tip(*mesh_, face.cell)) add_tractions(face, t, rows);
      add_loads_of_sides(t, rows);
    });
    loaded_ = true;
  }

 private:
  using Cells = assembly::Assembler<EnrichedCell<shape>>;
  using Sides = assembly::Assembler<BalancedSide<shape>>;

  /// Values at all nodes; zero without tip functions.
  std::vector<Real> shown(const assembly::State& state) const {
    const auto q = base::to_host(state.x[q_]);
    std::vector<Real> values;
    for (LocalIndex node = 0; node < mesh_->n_nodes(); ++node)
      for (int i = 0; i < dim; ++i)
        values.push_back(mesh_->enriched[node] < 0 ? 0 : q(mesh_->enriched[node] * dim + i));
    return values;
  }

  const laws::Elasticity& law(LocalIndex cell) const { return parameters_.elasticity.of_cell(*mesh_, cell); }

  Tip tip(LocalIndex cell) const { return {*mesh_, cell, rules_}; }

  /// Sets the block of nodes a and b.
  template <class Matrix>
  static void set_stiffness(const laws::Elasticity& elasticity, const Real (&moment)[n * dim][n * dim], int a, int b,
                            const Matrix& matrix) {
    Real one[dim][dim], stiffness[dim][dim];
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) one[i][j] = moment[a * dim + i][b * dim + j];
    elasticity.stiffness(one, stiffness);
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) matrix(a * dim + i, b * dim + j) = stiffness[i][j];
  }

  void build_cells() {
    constexpr int size = n * dim;
    const base::HostTable<Real***> mixed("mixed", cell_of_.size(), size, size), own("own", cell_of_.size(), size, size);
    for (std::size_t c = 0; c < cell_of_.size(); ++c) {
      const auto& elasticity = law(cell_of_[c]);
      Real mixed_moment[size][size] = {}, own_moment[size][size] = {};  // integrals of grad_i grad_j
      tip(cell_of_[c]).for_each_point([&](const auto&, Real volume, const auto&, const auto& v) {
        Real grad_N[size], grad_psi[size];
        for (int k = 0; k < size; ++k) {
          grad_N[k] = v.grad_N[k / dim][k % dim];
          grad_psi[k] = v.grad_psi[k / dim][k % dim];
        }
        for (int k = 0; k < size; ++k) {
          const Real N = volume * grad_N[k], psi = volume * grad_psi[k];
          for (int l = 0; l < size; ++l) mixed_moment[k][l] += N * grad_psi[l];
          for (int l = 0; l < size; ++l) own_moment[k][l] += psi * grad_psi[l];
        }
      });
      for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) {
          set_stiffness(elasticity, mixed_moment, a, b, Kokkos::subview(mixed.host(), c, Kokkos::ALL, Kokkos::ALL));
          set_stiffness(elasticity, own_moment, a, b, Kokkos::subview(own.host(), c, Kokkos::ALL, Kokkos::ALL));
        }
    }
    cell_ = {mixed.on_device(), own.on_device()};
  }

  void build_sides() {
    const auto selected = assembly::tip_sides(*mesh_);
    const auto all = assembly::fracture_sides(*mesh_);
    side_ = BalancedSide<shape>(selected.size());
    const base::HostTable<Real***> coupling(side_.coupling), frame(side_.frame);
    const base::HostTable<Real**> push(side_.push);
    for (std::size_t s = 0; s < selected.size(); ++s) {
      const auto [f, side] = all[selected[s]];
      const auto& face = mesh_->fracture_faces[f];
      const int local_face = face.local_face[side];
      const auto& elasticity = law(face.cell[side]);
      const Tip tip = this->tip(face.cell[side]);
      tip.for_each_point([&](const Real(&xi)[dim], Real volume, const auto&, const auto& v) {
        Real db[dim], gb[dim] = {};
        Tip::Cell::bubble(local_face, xi, db);
        tip.gradient(xi, db, gb);
        for (int a = 0; a < n; ++a)
          for (int i = 0; i < dim; ++i)
            for (int j = 0; j < dim; ++j)
              coupling(s, i, a * dim + j) += volume * elasticity.stiffness(gb, v.grad_psi[a], i, j);
      });
      const auto means = tip.face_means(local_face);
      for (int k = 0; k < Tip::n_face; ++k)
        push(s, mesh::face_nodes(shape)[local_face][k]) = (side == mesh::plus ? face.area : -face.area) * means[k];
      for (int k = 0; k < dim; ++k)
        for (int i = 0; i < dim; ++i) frame(s, k, i) = face.frame[k][i];
    }
    coupling.on_device();
    frame.on_device();
    push.on_device();
  }

  /// Owned row of component i of an enriched node of a cell; -1: none.
  LocalIndex row(LocalIndex cell, int node, int i) const {
    const LocalIndex number = mesh_->enriched[mesh_->cells[cell * n + node]];
    return number < 0 || number >= mesh_->n_owned_enriched ? -1 : number * dim + i;
  }
  template <class Host>
  void add(const Host& load, LocalIndex cell, int node, int i, Real value) const {
    if (const LocalIndex at = row(cell, node, i); at >= 0) load(at) += value;
  }

  /// Adds body force and initial stress.
  template <class Host>
  void add_volume_loads(LocalIndex cell, Real t, const Host& load) const {
    const auto& stress = parameters_.initial_stress;
    if (parameters_.body_force.empty() && stress.empty()) return;
    Real sigma[dim][dim] = {};
    tip(cell).for_each_point([&](const auto&, Real volume, const auto& x, const auto& v) {
      if (!stress.empty()) stress.at(*mesh_, cell, x, sigma);
      for (int i = 0; i < dim; ++i) {
        const Real force = parameters_.body_force.empty() ? 0 : parameters_.body_force(i, cell, x, t);
        for (int a = 0; a < n; ++a) {
          Real value = v.psi[a] * force;
          for (int j = 0; j < dim; ++j) value -= sigma[i][j] * v.grad_psi[a][j];
          add(load, cell, a, i, volume * value);
        }
      }
    });
  }

  template <class Host>
  void add_loads_of_sides(Real t, const Host& load) const {
    const auto selected = assembly::tip_sides(*mesh_);
    const auto all = assembly::fracture_sides(*mesh_);
    const auto push = base::to_host(side_.push);
    for (std::size_t s = 0; s < selected.size(); ++s) {
      const auto [f, side] = all[selected[s]];
      if (!parameters_.initial_stress.empty()) add_deviation(f, side, load);
      if (!fluid_.empty()) add_pressure(f, side, t, Kokkos::subview(push, s, Kokkos::ALL), load);
    }
  }

  template <class Host>
  void add_tractions(const mesh::Mesh::BoundaryFace& face, Real t, const Host& load) const {
    for (const auto& traction : parameters_.tractions) {
      if (!traction.applies_to(*mesh_, face)) continue;
      const auto at = traction.on(*mesh_, face);
      tip(face.cell).for_each_face_point(face.local_face,
                                         [&](const auto&, const auto& psi, const auto& area, const auto& x) {
                                           for (int k = 0; k < Tip::n_face; ++k)
                                             for (int i = 0; i < dim; ++i)
                                               add(load, face.cell, mesh::face_nodes(shape)[face.local_face][k], i,
                                                   psi[k] * mesh::norm(area) * at(i, x, t));
                                         });
    }
  }

  /// Adds the deviation of the initial traction from its mean over the face, which the rock carries.
  template <class Host>
  void add_deviation(LocalIndex f, int side, const Host& load) const {
    const auto& face = mesh_->fracture_faces[f];
    const LocalIndex cell = face.cell[side];
    const auto& stress = parameters_.initial_stress;
    const auto mean = mean_initial_traction(stress, *mesh_, face, side);
    const Real sign = side == mesh::plus ? 1 : -1;
    tip(cell).for_each_face_point(face.local_face[side],
                                  [&](const auto&, const auto& psi, const auto& area, const auto& x) {
                                    const auto traction = stress.traction(*mesh_, cell, x, face.frame[0]);
                                    for (int k = 0; k < Tip::n_face; ++k)
                                      for (int i = 0; i < dim; ++i)
                                        add(load, cell, mesh::face_nodes(shape)[face.local_face[side]][k], i,
                                            -sign * psi[k] * mesh::norm(area) * (traction[i] - mean[i]));
                                  });
  }

  /// Adds the mean fluid pressure over the face, which pushes the sides apart.
  template <class Push, class Host>
  void add_pressure(LocalIndex f, int side, Real t, const Push& push, const Host& load) const {
    const auto& face = mesh_->fracture_faces[f];
    const Real p = mean_bearing_pressure(fluid_, *mesh_, f, side, t);
    for (int a = 0; a < n; ++a)
      for (int i = 0; i < dim; ++i) add(load, face.cell[side], a, i, p * push(a) * face.frame[0][i]);
  }

  BulkMomentumParameters parameters_;
  FluidPressure fluid_;
  RCP<const mesh::Mesh> mesh_;
  int q_ = -1;
  bool loaded_ = false;
  std::vector<LocalIndex> cell_of_;  // [entity of tip_cells]
  std::shared_ptr<assembly::TipRules> rules_ = std::make_shared<assembly::TipRules>();
  EnrichedCell<shape> cell_;
  BalancedSide<shape> side_{0};  // without bubbles: see InterfaceTractionBalance
  std::unique_ptr<Cells> cells_;
  std::unique_ptr<Sides> sides_;
  assembly::Load load_;  // N
};

}  // namespace

std::unique_ptr<assembly::Module> make_tip_enrichment(Shape shape, BulkMomentumParameters parameters,
                                                      FluidPressure fluid_pressure) {
  SPREKK_CHECK(mesh::order(shape) == 1, "tip enrichment: needs cells of order 1");
  return mesh::for_corners(shape, [&](auto s) -> std::unique_ptr<assembly::Module> {
    return std::make_unique<TipEnrichment<s()>>(std::move(parameters), std::move(fluid_pressure));
  });
}

}  // namespace sprekk::physics
