#include "transport/hybrid_diffusion.hpp"

#include "assembly/capabilities.hpp"
#include "assembly/term.hpp"
#include "base/host_table.hpp"
#include "base/over_ranks.hpp"
#include "mesh/extents.hpp"
#include "mesh/facets.hpp"
#include "transport/changed_flow.hpp"
#include "transport/flux_scheme.hpp"
#include "transport/hybrid_rock.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::transport {

using assembly::Loop;

namespace {

template <Shape shape>
class HybridDiffusion final : public assembly::Module,
                              public assembly::Loads,
                              public assembly::InitialValues,
                              public assembly::Totals {
 public:
  using Op = HybridCell<shape>;
  static constexpr int dim = Op::dim, n_faces = Op::n;

  explicit HybridDiffusion(HybridDiffusionParameters parameters)
      : parameters_(std::move(parameters)), outflow_(parameters_.conditions, parameters_.outflow) {}

  std::string name() const override {
    return parameters_.name + ", " + name_of(parameters_.scheme) +
           (parameters_.reason.empty() ? "" : " (" + parameters_.reason + ")");
  }

  void set_fields(const std::set<std::string>& fields) override {
    const auto& others = parameters_.coupled_by;
    coupled_ = parameters_.change ||
               std::any_of(others.begin(), others.end(), [&](const auto& name) { return fields.count(name) > 0; });
  }

  assembly::Declaration declare(const mesh::Mesh& mesh) const override {
    assembly::Declaration d;
    const auto& [field, on_facets] = names_;
    const Real conductance = largest_mobility(mesh) / mesh::largest_extent(mesh) * mesh::typical_face_area(mesh);
    assembly::Unknown cells{{field, fields::Entity::cell, 1, parameters_.unit}, field, {{field, conductance}}};
    cells.balance = true;
    cells.reactions = {parameters_.outflow.inflows, "", "region_" + parameters_.outflow.inflows,
                       parameters_.outflow.unit};
    auto facets = cells;
    facets.field = {on_facets, fields::Entity::facet, 1, parameters_.unit};
    facets.near_null_space = assembly::NearNullSpace::constants;
    facets.reactions.fractures = "fracture_" + parameters_.outflow.inflows;
    const bool stay = parameters_.in_regions || coupled_;
    (stay ? cells.condensed_into : cells.local_group) = stay ? on_facets : field + " in cells";
    d.unknowns = {cells, facets};
    d.scales = {{field, 1e-12}};
    for (const auto& row : names_) d.couplings.push_back({Loop::cells, row, columns()});
    d.outputs = {{{field, parameters_.unit, fields::Entity::cell, 1}, [this](const auto& s) { return values(s); }},
                 {{parameters_.flux, parameters_.flux_unit, fields::Entity::cell, 3},
                  [this](const auto& s) { return fluxes(s); }}};
    d.linear = is_linear();
    return d;
  }

  void bind(const assembly::Context& context) override {
    mesh_ = context.mesh();
    size_ = mesh::largest_extent(*mesh_);
    op_ = std::make_unique<Op>(hybrid_cell<shape>(context, parameters_));
    blocks_ = {context.field(names_[0]), context.field(names_[1])};
    set_flow(context);
    for (int k = 0; k < 2; ++k) load_[k] = assembly::Load(context.layout(blocks_[k]).n_owned());
    add_conditions();
    outflow_.bind(context, blocks_[1], parameters_.fluid);
  }

  void initial(const assembly::Rows& x) const override {
    if (parameters_.initial) put_initial(*mesh_, *parameters_.initial, x[blocks_[0]], x[blocks_[1]]);
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    flow_.add_residual(state, r);
    outflow_.add_residual(state, r);
    for (int k = 0; k < 2; ++k) load_[k].add_to(r[blocks_[k]]);
  }

  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    flow_.add_jacobian(state, J);
    outflow_.add_jacobian(state, J);
  }
  bool symmetric(const assembly::State&) const override { return is_linear(); }

  bool constant_load() const override {
    return outflow_.constant_in_time() && (parameters_.source.empty() || parameters_.source[0].constant_in_time());
  }

  void set_time(Real t, const assembly::Scales&) override {
    if (loaded_ && constant_load()) return;
    load_[0].set([&](const auto& rows) {
      for_each_source(t, [&](LocalIndex cell, Real volume, Real source) { rows(cell) -= volume * source; });
    });
    load_[1].set([&](const auto& rows) { outflow_.set_time(t, rows); });
    loaded_ = true;
  }

  /// Scale of u: its difference over the domain due to prescribed flows and gravity.
  assembly::Scales loads(Real t) const override {
    Real flux = outflow_.largest(t, false), weight = 0, mobility = 0;
    for_each_source(t, [&](LocalIndex, Real, Real source) { flux = std::max(flux, size_ * std::abs(source)); });
    for (Real component : parameters_.weight) weight += component * component;
    for (const auto& each : parameters_.mobility.values)
      mobility = std::max(mobility, each.template trace<dim>() / dim);
    return {{parameters_.field, std::max(outflow_.largest(t, true), size_ * (std::sqrt(weight) + flux / mobility))}};
  }

  void totals(const assembly::State& state, std::vector<assembly::Total>& totals) const override {
    outflow_.totals(state, *mesh_, totals);
  }

 private:
  std::vector<std::string> columns() const {
    std::vector<std::string> all = {names_[0], names_[1]};
    if (parameters_.change) all.push_back(parameters_.change->field);
    return all;
  }
  ChangedFlow<Op> changed() const { return {*op_, parameters_.change->response}; }

  void set_flow(const assembly::Context& context) {
    std::vector<int> columns;
    for (const auto& name : this->columns()) columns.push_back(context.field(name));
    const auto set = [&](auto op) {
      flow_ = assembly::Term(context, Loop::cells, blocks_, columns, !is_linear(), [op](const auto&) { return op; });
    };
    if (!parameters_.change) return set(*op_);
    carried_ = columns.back();
    set(changed());
  }

  std::vector<Real> values(const assembly::State& state) const {
    const auto u = base::to_host(state.x[blocks_[0]]);
    return {u.data(), u.data() + mesh_->n_owned_cells};
  }

  std::vector<Real> fluxes(const assembly::State& state) const {
    const auto u = base::to_host(state.x[blocks_[0]]);
    const auto trace = base::to_host(state.x[blocks_[1]]);
    const bool changes = parameters_.change.has_value();
    const auto carried = base::to_host(state.x[changes ? carried_ : blocks_[0]]);
    std::vector<Real> values;
    Real X[mesh::n_nodes(shape)][dim], x[1 + n_faces], q[n_faces];
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c) {
      assembly::gather_host<shape>(*mesh_, c, X);
      const CellFaces<shape> faces(X);
      x[0] = u(c);
      for (int k = 0; k < n_faces; ++k) x[1 + k] = trace(mesh_->facets->of_cell[c * n_faces + k]);
      const auto [density, mobility] = changes ? factors(carried(c)) : std::array<Real, 2>{1, 1};
      op_->at(c, faces).heavier(density).flow(x, q);
      const Real scale = mobility / (parameters_.fluid.density(x[0]) * faces.volume);
      for (int i = 0; i < 3; ++i) {
        Real v = 0;
        for (int k = 0; k < n_faces && i < dim; ++k) v += q[k] * faces.centre[k][i] * scale;
        values.push_back(v);
      }
    }
    return values;
  }

  /// Factors of density and mobility.
  std::array<Real, 2> factors(Real carried) const {
    const auto& response = parameters_.change->response;
    return {response.density(carried).value, response.mobility(carried).value};
  }

  /// Largest diagonal component of the mobility. Collective.
  Real largest_mobility(const mesh::Mesh& mesh) const {
    Real here = 0;
    for (const auto& one : parameters_.mobility.values)
      for (int i = 0; i < dim; ++i) here = std::max(here, one.value[i][i]);
    return base::max_over_ranks(*mesh.comm, here);
  }

  bool is_linear() const { return parameters_.fluid.compressibility == 0 && !parameters_.change; }

  /// Adds the quadrature points of all boundary faces with a condition.
  void add_conditions() {
    for (std::size_t k = 0; k < outflow_.conditions().size(); ++k)
      for (const auto& face : mesh_->boundary_faces) {
        const auto& one = outflow_.conditions()[k];
        if (face.boundary != one.boundary || (one.region >= 0 && mesh_->cell_region[face.cell] != one.region)) continue;
        const LocalIndex facet = mesh_->facets->of_cell[face.cell * n_faces + face.local_face];
        assembly::for_each_face_point(*mesh_, face.cell, face.local_face,
                                      [&](const auto&, Real area, const auto& x) { outflow_.add(k, facet, area, x); });
      }
  }

  /// Calls visit(cell, volume, source) at the quadrature points of owned cells.
  template <class Visit>
  void for_each_source(Real t, const Visit& visit) const {
    for (LocalIndex c = 0; c < mesh_->n_owned_cells && !parameters_.source.empty(); ++c)
      assembly::for_each_cell_point(*mesh_, c,
                                    [&](Real volume, const auto& x) { visit(c, volume, parameters_.source[0](x, t)); });
  }

  HybridDiffusionParameters parameters_;
  std::array<std::string, 2> names_{parameters_.field, "face " + parameters_.field};
  bool coupled_ = false;
  RCP<const mesh::Mesh> mesh_;
  std::vector<int> blocks_;  // u of cells, u of facets
  Real size_ = 0;            // largest extent of the domain, m
  bool loaded_ = false;
  std::unique_ptr<Op> op_;
  assembly::Term flow_;
  int carried_ = -1;  // block of the field that changes the fluid
  Outflow outflow_;
  std::array<assembly::Load, 2> load_;  // Q per time
};

}  // namespace

void put_initial(const mesh::Mesh& mesh, const base::Expression& u, const View<Real*>& cells,
                 const View<Real*>& facets) {
  const base::HostTable<Real*> in_cells(cells);
  for (LocalIndex c = 0; c < mesh.n_owned_cells; ++c)
    in_cells(c) = assembly::cell_mean(mesh, c, [&](const auto& x) { return u(x, 0); })[1];
  in_cells.on_device();
  put_initial(mesh, u, facets);
}

void put_initial(const mesh::Mesh& mesh, const base::Expression& u, const View<Real*>& facets) {
  const base::HostTable<Real*> values(facets);
  const auto put = [&](LocalIndex facet, const mesh::Vector& x) {
    if (facet >= 0 && facet < mesh.facets->n_owned) values(facet) = u(x, 0);
  };
  const int n_faces = mesh::n_faces(mesh.shape), n_ridges = mesh::n_face_corners(mesh.shape);
  for (LocalIndex f = 0; f < mesh.n_cells() * n_faces && mesh.facets->in_rock; ++f)
    put(mesh.facets->of_cell[f], mesh::face_centre(mesh::face_corners(mesh, f / n_faces, f % n_faces)));
  for (LocalIndex f = 0; f < mesh.n_fracture_faces(); ++f) {
    put(mesh.facets->fracture_face[f], mesh.fracture_faces[f].centre);
    for (int k = 0; k < n_ridges; ++k) put(mesh.facets->ridge[f * n_ridges + k], mesh::ridge_centre(mesh, f, k));
  }
  values.on_device();
}

std::unique_ptr<assembly::Module> make_hybrid_diffusion(Shape shape, HybridDiffusionParameters parameters) {
  return mesh::for_corners(shape, [&](auto s) -> std::unique_ptr<assembly::Module> {
    return std::make_unique<HybridDiffusion<s()>>(std::move(parameters));
  });
}

}  // namespace sprekk::transport
