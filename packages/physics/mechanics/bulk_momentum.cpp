#include "physics/mechanics/bulk_momentum.hpp"

#include "assembly/assembler.hpp"
#include "assembly/capabilities.hpp"
#include "assembly/load.hpp"
#include "assembly/tip_cell.hpp"
#include "base/host_table.hpp"
#include "base/over_ranks.hpp"
#include "mesh/extents.hpp"
#include "physics/mechanics/elastic_cell.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::physics {

using assembly::Loop;
using mesh::Shape;

namespace {

template <Shape shape>
class BulkMomentum final : public assembly::Module,
                           public assembly::Loads,
                           public assembly::Steps,
                           public assembly::Transfer {
 public:
  using Op = ElasticCell<shape>;
  static constexpr int dim = Op::dim, n = Op::n;

  explicit BulkMomentum(BulkMomentumParameters parameters) : parameters_(std::move(parameters)) {}

  std::string name() const override { return "bulk momentum"; }

  void set_fields(const std::set<std::string>& fields) override { split_ = fields.count("solid pressure") > 0; }

  assembly::Declaration declare(const mesh::Mesh& mesh) const override {
    const Real E = largest_modulus(mesh), L = mesh::largest_extent(mesh);
    assembly::Declaration d;
    assembly::Unknown u{
        {"displacement", fields::Entity::node, dim, "m"}, "displacement", {{"stress", mesh::typical_face_area(mesh)}}};
    u.near_null_space = assembly::NearNullSpace::rigid_motions;
    u.reactions = {"reactions", "reaction_moments", "", dim == 2 ? "N/m" : "N"};
    d.unknowns = {u};
    d.couplings = {{Loop::cells, "displacement", {"displacement"}}};
    d.scales = {{"stress", 1e-12 * E}, {"displacement", 1e-12 * L}};
    d.relations = {{"stress", E / L, "displacement"}, {"displacement", L / E, "stress"}};
    d.outputs = {{{"displacement", "m", fields::Entity::node, dim}, [this](const auto& s) { return displacements(s); }},
                 {{"stress", "Pa", fields::Entity::cell, 6}, [this](const auto& s) { return stresses(s); }}};
    d.linear = true;
    if (parameters_.keeps_stress)
      d.history = {{forces_of_cells, fields::Entity::cell, n * dim}, {stress_of_cells, fields::Entity::cell, 6}};
    return d;
  }

  void bind(const assembly::Context& context) override {
    mesh_ = context.mesh();
    size_ = mesh::largest_extent(*mesh_);
    initial_size_ = largest_initial_stress();
    op_ = std::make_unique<Op>(Op{context.geometry(), assembly::to_device(parameters_.elasticity.values, "material"),
                                  assembly::material_numbers(context.geometry(), parameters_.elasticity.number)});
    displacement_ = context.field("displacement");
    if (split_) solid_pressure_ = context.field("solid pressure");
    if (mesh_->n_global_enriched > 0) tip_displacement_ = context.field("tip displacement");
    using Assembler = assembly::Assembler<Op>;
    cells_ = std::make_unique<Assembler>(context, Loop::cells, std::vector<int>{displacement_},
                                         std::vector<int>{displacement_}, Assembler::Positions::once);
    if (has_load()) load_ = assembly::Load(context.layout(displacement_).n_owned());
    if (!parameters_.keeps_stress) return;
    carried_ = assembly::Load(context.layout(displacement_).n_owned());
    all_cells_.emplace(fields::Field{forces_of_cells, fields::Entity::cell, n * dim, "N"}, *mesh_);
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    cells_->add_residual(*op_, state, r);
    if (has_load()) load_.add_to(r[displacement_], -1);
    if (parameters_.keeps_stress) carried_.add_to(r[displacement_]);
  }

  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    cells_->add_jacobian(*op_, state, J);
  }

  bool constant_load() const override { return !parameters_.keeps_stress && has_constant_loads(); }

  void set_time(Real t, const assembly::Scales&) override {
    if (!has_load() || (loaded_ && has_constant_loads())) return;
    load_.set([&](const auto& rows) {
      add_body_force(t, rows);
      add_initial_stress(rows);
      for (const auto& traction : parameters_.tractions) add_traction(traction, t, rows);
    });
    loaded_ = true;
  }

  /// Sums the carried forces of cells at their nodes.
  void start_step(const assembly::State& state) override {
    if (!parameters_.keeps_stress) return;
    fields::Vector owned(all_cells_->owned()), all(all_cells_->ghosted());
    Kokkos::deep_copy(values_of(owned), state.history[0]);
    all.doImport(owned, *all_cells_->import(), Tpetra::REPLACE);
    const auto forces = base::to_host(values_of(all));
    carried_.set([&](const auto& rows) {
      for (LocalIndex c = 0; c < mesh_->n_cells(); ++c)
        for (int a = 0; a < n; ++a)
          for (int i = 0; i < dim; ++i)
            add(rows, mesh_->free_node(mesh_->cells[c * n + a]) * dim + i, forces(c, a * dim + i));
    });
  }

  void pass_on(const assembly::State& state,
               std::vector<std::pair<assembly::History, View<Real**>>>& histories) const override {
    const View<Real**> forces("forces of cells", mesh_->n_owned_cells, n * dim),
        stress("stress of cells", mesh_->n_owned_cells, 6);
    if (parameters_.keeps_stress) {
      Kokkos::deep_copy(forces, state.history[0]);
      Kokkos::deep_copy(stress, state.history[1]);
    }
    add_constitutive(1, state, forces, stress);
    histories.push_back({{forces_of_cells, fields::Entity::cell, n * dim}, forces});
    histories.push_back({{stress_of_cells, fields::Entity::cell, 6}, stress});
  }

  void take_over(assembly::State& state) const override {
    if (parameters_.keeps_stress) add_constitutive(-1, state, state.history[0], state.history[1]);
  }

  /// Stress scale: largest of traction, initial stress at cell centres, and body force times the size of the domain.
  /// The body force is evaluated at the first node of each cell.
  assembly::Scales loads(Real t) const override {
    Real largest = initial_size_;
    for (const auto& traction : parameters_.tractions)
      for (const auto& face : mesh_->boundary_faces)
        if (traction.applies_to(*mesh_, face))
          assembly::for_each_face_point(*mesh_, face.cell, face.local_face,
                                        [&, at = traction.on(*mesh_, face)](const auto&, Real, const auto& x) {
                                          for (int i = 0; i < dim; ++i)
                                            largest = std::max(largest, std::abs(at(i, x, t)));
                                        });
    Real force = 0;
    for (LocalIndex c = 0; c < mesh_->n_cells() && !parameters_.body_force.empty(); ++c) {
      std::array<Real, 3> x{};
      std::copy_n(mesh_->coordinates.begin() + mesh_->cells[c * n] * dim, dim, x.begin());
      for (int i = 0; i < dim; ++i) force = std::max(force, std::abs(parameters_.body_force(i, c, x, t)));
    }
    return {{"stress", std::max(largest, force * size_)}};
  }

  /// Adds `factor` times the forces on the nodes of owned cells, and their stress, with the present constants.
  void add_constitutive(Real factor, const assembly::State& state, const View<Real**>& forces,
                        const View<Real**>& stress) const {
    const auto op = *op_;
    const LocalIndex n_owned = mesh_->n_owned_cells;
    cells_->for_each(
        op, state, KOKKOS_LAMBDA(int cell, const Real(&x)[n * dim]) {
          if (cell >= n_owned) return;
          Real f[n * dim];
          op.residual(cell, x, f);
          for (int k = 0; k < n * dim; ++k) forces(cell, k) += factor * f[k];
        });
    const auto on_host = base::to_host(stress);
    const auto values = constitutive_stresses(state);
    for (std::size_t k = 0; k < values.size(); ++k) on_host(k / 6, k % 6) += factor * values[k];
    Kokkos::deep_copy(stress, on_host);
    if (parameters_.initial_stress.empty()) return;
    const auto f = base::to_host(forces);
    for (LocalIndex c = 0; c < n_owned; ++c)
      for_initial_forces(c, [&](int k, Real force) { f(c, k) += factor * force; });
    Kokkos::deep_copy(forces, f);
  }

 private:
  std::vector<Real> displacements(const assembly::State& state) const {
    const auto u = base::to_host(state.x[displacement_]);
    std::vector<Real> values;
    for (LocalIndex node = 0; node < mesh_->n_nodes(); ++node)
      for (int i = 0; i < dim; ++i) values.push_back(u(mesh_->free_node(node) * dim + i));
    return values;
  }
  std::vector<Real> stresses(const assembly::State& state) const {
    auto values = constitutive_stresses(state);
    if (!parameters_.keeps_stress) return values;
    const auto carried = base::to_host(state.history[1]);
    for (std::size_t k = 0; k < values.size(); ++k) values[k] += carried(k / 6, k % 6);
    return values;
  }
  /// Stress without the carried stress.
  std::vector<Real> constitutive_stresses(const assembly::State& state) const {
    const auto u = base::to_host(state.x[displacement_]);
    const auto q = tip_displacement_ < 0 ? u : base::to_host(state.x[tip_displacement_]);
    std::vector<Real> values;
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c) add_stress(c, u, q, values);
    if (!split_) return values;
    const auto p = base::to_host(state.x[solid_pressure_]);
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c)
      for (int k = 0; k < 3; ++k) values[6 * c + k] -= p(c);
    return values;
  }

  Real largest_initial_stress() const {
    Real largest = 0;
    for (LocalIndex c = 0; c < mesh_->n_cells() && !parameters_.initial_stress.empty(); ++c)
      for (const auto& component : parameters_.initial_stress.of_cell(*mesh_, c))
        largest = std::max(largest, std::abs(component(mesh::cell_centre(*mesh_, c), 0)));
    return largest;
  }

  bool has_constant_loads() const {
    const auto& all = parameters_.tractions;
    return parameters_.body_force.constant_in_time() &&
           std::all_of(all.begin(), all.end(), [](const auto& traction) { return traction.constant_in_time(); });
  }
  bool has_load() const {
    return !parameters_.body_force.empty() || !parameters_.tractions.empty() || !parameters_.initial_stress.empty();
  }
  /// Largest Young's modulus, Pa. Collective.
  Real largest_modulus(const mesh::Mesh& mesh) const {
    Real here = 0;
    for (LocalIndex c = 0; c < mesh.n_owned_cells; ++c)
      here = std::max(here, parameters_.elasticity.of_cell(mesh, c).youngs_modulus());
    return base::max_over_ranks(*mesh.comm, here);
  }

  template <class Host>
  void add_body_force(Real t, const Host& load) const {
    if (parameters_.body_force.empty()) return;
    Real N[n];
    for (LocalIndex c = 0; c < mesh_->n_cells(); ++c)
      assembly::for_each_cell_point<shape>(*mesh_, c, [&](const Real(&xi)[dim], Real volume, const auto& x) {
        Op::Cell::shape_functions(xi, N);
        for (int i = 0; i < dim; ++i) {
          const Real force = volume * parameters_.body_force(i, c, x, t);
          for (int a = 0; a < n; ++a) add(load, mesh_->free_node(mesh_->cells[c * n + a]) * dim + i, N[a] * force);
        }
      });
  }

  template <class Host>
  void add_initial_stress(const Host& load) const {
    if (parameters_.initial_stress.empty()) return;
    for (LocalIndex c = 0; c < mesh_->n_cells(); ++c)
      for_initial_forces(c, [&](int k, Real force) {
        add(load, mesh_->free_node(mesh_->cells[c * n + k / dim]) * dim + k % dim, -force);
      });
  }

  /// Calls use(node dim + i, part) for parts of integral sigma_0 : grad(N_node e_i) over a cell.
  template <class Use>
  void for_initial_forces(LocalIndex c, const Use& use) const {
    Real X[n][dim], dN[n][dim], g[dim], sigma[dim][dim];
    assembly::gather_host<shape>(*mesh_, c, X);
    assembly::for_each_cell_point<shape>(*mesh_, c, [&](const Real(&xi)[dim], Real volume, const auto& x) {
      parameters_.initial_stress.at(*mesh_, c, x, sigma);
      Op::Cell::gradients(xi, dN);
      const assembly::CellPoint<shape> point(X, dN);
      for (int a = 0; a < n; ++a) {
        point.gradient(dN[a], g);
        for (int i = 0; i < dim; ++i)
          for (int j = 0; j < dim; ++j) use(a * dim + i, volume * sigma[i][j] * g[j]);
      }
    });
  }

  template <class Host>
  void add_traction(const BoundaryTraction& traction, Real t, const Host& load) const {
    for (const auto& face : mesh_->boundary_faces) {
      if (!traction.applies_to(*mesh_, face)) continue;
      const auto at = traction.on(*mesh_, face);
      const auto corners = mesh::face_nodes(shape)[face.local_face];
      assembly::for_each_face_point(*mesh_, face.cell, face.local_face, [&](const auto& N, Real area, const auto& x) {
        for (int i = 0; i < dim; ++i) {
          const Real force = area * at(i, x, t);
          for (int k = 0; k < mesh::n_face_nodes(shape); ++k)
            add(load, mesh_->free_node(mesh_->cells[face.cell * n + corners[k]]) * dim + i, N[k] * force);
        }
      });
    }
  }

  template <class Host>
  static void add(const Host& load, LocalIndex row, Real value) {
    if (row < static_cast<LocalIndex>(load.extent(0))) load(row) += value;
  }

  /// Appends the stress at the centre of cell c; in 2D with the plane-strain sigma_zz.
  template <class Host>
  void add_stress(LocalIndex c, const Host& u, const Host& q, std::vector<Real>& values) const {
    Real X[n][dim], xi[dim], dN[n][dim], H[dim][dim] = {}, sigma[dim][dim];
    assembly::gather_host<shape>(*mesh_, c, X);
    Op::Cell::centre(xi);
    Op::Cell::gradients(xi, dN);
    const assembly::CellPoint<shape> point(X, dN);
    Real trace = 0;
    for (int a = 0; a < n; ++a) {
      Real g[dim];
      point.gradient(dN[a], g);
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) H[i][j] += u(mesh_->free_node(mesh_->cells[c * n + a]) * dim + i) * g[j];
    }
    if constexpr (mesh::order(shape) == 1)
      if (assembly::has_tip(*mesh_, c)) {
        typename assembly::TipCell<shape>::Values v;
        assembly::TipCell<shape>(*mesh_, c).at(xi, v);
        for (int a = 0; a < n; ++a)
          if (const LocalIndex number = mesh_->enriched[mesh_->cells[c * n + a]]; number >= 0)
            for (int i = 0; i < dim; ++i)
              for (int j = 0; j < dim; ++j) H[i][j] += q(number * dim + i) * v.grad_psi[a][j];
      }
    const auto& law = parameters_.elasticity.of_cell(*mesh_, c);
    law.stress(H, sigma);
    for (int i = 0; i < dim; ++i) trace += H[i][i];
    if constexpr (dim == 2)
      values.insert(values.end(), {sigma[0][0], sigma[1][1], law.lambda * trace, sigma[0][1], 0, 0});
    else
      values.insert(values.end(), {sigma[0][0], sigma[1][1], sigma[2][2], sigma[0][1], sigma[1][2], sigma[0][2]});
    if (parameters_.initial_stress.empty()) return;
    std::array<Real, 3> x{};
    Real N[n];
    Op::Cell::shape_functions(xi, N);
    for (int a = 0; a < n; ++a)
      for (int i = 0; i < dim; ++i) x[i] += N[a] * X[a][i];
    const auto& initial = parameters_.initial_stress.of_cell(*mesh_, c);
    for (std::size_t k = 0; k < initial.size(); ++k) values[values.size() - 6 + k] += initial[k](x, 0);
  }

  /// View of the values as [owned entity, component].
  static View<Real**> values_of(fields::Vector& vector) {
    const auto local = vector.getLocalViewDevice(Tpetra::Access::ReadWrite);
    return View<Real**>(local.data(), local.extent(0) / (n * dim), n * dim);
  }

  static constexpr const char *forces_of_cells = "carried forces", *stress_of_cells = "carried stress";

  BulkMomentumParameters parameters_;
  RCP<const mesh::Mesh> mesh_;
  int displacement_ = -1, tip_displacement_ = -1, solid_pressure_ = -1;
  bool loaded_ = false, split_ = false;  // split_: has a solid pressure
  Real size_ = 0;                        // largest extent of the domain, m
  Real initial_size_ = 0;                // largest component of the initial stress on this rank, Pa
  std::unique_ptr<Op> op_;
  std::unique_ptr<assembly::Assembler<Op>> cells_;
  assembly::Load load_, carried_;  // N
  std::optional<fields::Layout> all_cells_;
};

}  // namespace

bool BoundaryTraction::constant_in_time() const {
  return std::all_of(value.begin(), value.end(), [](const auto& e) { return e.constant_in_time(); }) &&
         (!pressure || pressure->constant_in_time());
}

std::unique_ptr<assembly::Module> make_bulk_momentum(Shape shape, BulkMomentumParameters parameters) {
  return mesh::for_shape(shape, [&](auto s) -> std::unique_ptr<assembly::Module> {
    return std::make_unique<BulkMomentum<s()>>(std::move(parameters));
  });
}

}  // namespace sprekk::physics
