#include "transport/fracture_flow.hpp"

#include "assembly/capabilities.hpp"
#include "assembly/term.hpp"
#include "base/host_table.hpp"
#include "base/over_ranks.hpp"
#include "mesh/extents.hpp"
#include "transport/fracture_faces.hpp"
#include "transport/hybrid_diffusion.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::transport {

using assembly::Loop;

namespace {

template <Shape shape>
class FractureFlow final : public assembly::Module,
                           public assembly::Loads,
                           public assembly::InitialValues,
                           public assembly::LaggedCoefficients,
                           public assembly::Totals {
 public:
  using Plane = FacePlane<shape>;
  static constexpr int dim = Plane::dim, n = Plane::n;
  using Op = FractureFace<n>;

  explicit FractureFlow(FractureFlowParameters parameters)
      : parameters_(std::move(parameters)), outflow_(parameters_.conditions, parameters_.outflow) {}

  std::string name() const override { return "fracture flow"; }
  void set_fields(const std::set<std::string>& fields) override { widens_ = fields.count("widening") > 0; }

  assembly::Declaration declare(const mesh::Mesh& mesh) const override {
    assembly::Declaration d;
    if (parameters_.alone) {
      d.unknowns = {pressure(mesh)};
      d.scales = {{"pressure", 1e-12}};
    }
    d.couplings = {{Loop::fracture_cells, "face pressure", drivers(parameters_, widens_)}};
    using assembly::Summary;
    d.outputs = {
        {{"fracture pressure", "Pa", fields::Entity::fracture_face, 1, {Summary::mean_and_max, "fracture pressure"}},
         [this](const auto& state) { return pressures(state); }},
        {{"fluid flux", "m^2/s", fields::Entity::fracture_face, 3, {Summary::mean, "fluid flux", "global"}},
         [this](const auto& state) { return fluxes(state); }},
        {{"hydraulic aperture", "m", fields::Entity::fracture_face, 1, {Summary::mean_and_max, "hydraulic aperture"}},
         [this](const auto& state) { return apertures(state); }},
        {{"fluid volume",
          "m",
          fields::Entity::fracture_face,
          1,
          {Summary::integral, "fluid volume", "", {}, dim == 2 ? "m^2" : "m^3"}},
         [this](const auto& state) { return volumes(state); }}};
    d.linear = is_linear();
    return d;
  }

  void bind(const assembly::Context& context) override {
    mesh_ = context.mesh();
    size_ = mesh::largest_extent(*mesh_);
    block_ = context.field("face pressure");
    faces_ = std::make_unique<FractureFaces<shape>>(mesh_, context.layout(block_), parameters_, widens_);
    if (widens_) widening_ = context.field("widening");
    if (parameters_.change) carried_ = context.field("face " + parameters_.change->field);
    set_flow(context);
    load_ = assembly::Load(context.layout(block_).n_owned());
    for_each_end([&](std::size_t condition, const mesh::Facets::Rim& rim, Real area, const auto& x) {
      outflow_.add(condition, mesh_->facets->ridge[rim.face * n + rim.ridge], area, x);
    });
    outflow_.bind(context, block_, parameters_.fluid);
  }

  void initial(const assembly::Rows& x) const override {
    if (parameters_.alone && parameters_.alone->initial) put_initial(*mesh_, *parameters_.alone->initial, x[block_]);
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    flow_.add_residual(state, r);
    outflow_.add_residual(state, r);
    load_.add_to(r[block_]);
  }

  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    flow_.add_jacobian(state, J);
    outflow_.add_jacobian(state, J);
  }
  /// Computes hydraulic apertures. Sealed faces have their residual aperture. `widest`: at least open_.
  void coefficients(const assembly::State& state, bool widest, std::vector<Real>& values) const override {
    if (!widens_) return;
    const auto widening = base::to_host(state.x[widening_]);
    for (std::size_t f = 0; f < values.size(); ++f)
      values[f] = std::max({parameters_.faces[f].along.hydraulic_aperture(widening(f)),
                            parameters_.faces[f].along.minimum, widest ? open_ : 0});
  }
  bool symmetric(const assembly::State&) const override { return is_linear(); }

  bool constant_load() const override {
    return outflow_.constant_in_time() && std::all_of(parameters_.source.begin(), parameters_.source.end(),
                                                      [](const auto& source) { return source.constant_in_time(); });
  }

  void set_time(Real t, const assembly::Scales& scales) override {
    if (widens_) open_ = std::min(of_displacement * scales.at("displacement"), of_size * size_);
    if (loaded_ && constant_load()) return;
    load_.set([&](const auto& rows) {
      for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f)
        for_each_source(f, t, [&](Real area, Real source) { rows(mesh_->facets->fracture_face[f]) -= area * source; });
      outflow_.set_time(t, rows);
    });
    loaded_ = true;
  }

  /// Scale of the pressure: its difference over the domain due to sources and prescribed flow.
  assembly::Scales loads(Real t) const override {
    Real largest = outflow_.largest(t, true);
    const auto let = [&](Real flow, const laws::Conduit& conduit) {
      if (flow != 0) largest = std::max(largest, pressure_for(size_ * std::abs(flow), conduit));
    };
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f)
      for_each_source(f, t, [&](Real, Real source) { let(source * size_, parameters_.faces[f].along); });
    for_each_end([&](std::size_t number, const mesh::Facets::Rim& rim, Real, const auto& x) {
      const auto& condition = outflow_.conditions()[number];
      const auto& conduit = parameters_.faces[rim.face].along;
      if (!condition.coefficient) let(conduit.hydraulic_aperture() * condition.value(x, t), conduit);
    });
    return {{"pressure", largest}};
  }

  void totals(const assembly::State& state, std::vector<assembly::Total>& totals) const override {
    outflow_.totals(state, *mesh_, totals);
  }

 private:
  static constexpr Real of_displacement = 1e-2, of_size = 1e-4;  // see open_

  /// Unknown of the facets of fractures. Collective.
  assembly::Unknown pressure(const mesh::Mesh& mesh) const {
    Real widest = 0;
    for (const auto& face : parameters_.faces) widest = std::max(widest, face.along.transmissivity());
    const Real ridge = dim == 2 ? 1 : std::sqrt(mesh::typical_face_area(mesh)),
               conductance = base::max_over_ranks(*mesh.comm, widest) * ridge / mesh::largest_extent(mesh);
    assembly::Unknown facets{{"face pressure", fields::Entity::facet, 1, "Pa"}, "pressure", parameters_.alone->row};
    facets.row.push_back({"pressure", conductance});
    facets.balance = true;
    const auto& inflows = parameters_.outflow.inflows;
    facets.reactions = {inflows, "", "region_" + inflows, parameters_.outflow.unit, "fracture_" + inflows};
    facets.near_null_space = assembly::NearNullSpace::constants;
    return facets;
  }

  void set_flow(const assembly::Context& context) {
    std::vector<int> columns;
    for (const auto& name : drivers(parameters_, widens_)) columns.push_back(context.field(name));
    with_fluid([&](const auto& op) {
      const auto set = [&](const auto& at) {
        flow_ = assembly::Term(context, Loop::fracture_cells, {block_}, columns, !is_linear(), at);
      };
      using Fluid = std::decay_t<decltype(op)>;
      if (widens_)
        set([op, conduits = faces_->conduits()](const assembly::State& state) {
          return WideningFace<Fluid>{op, {conduits, state.coefficients}};
        });
      else
        set([op](const assembly::State&) { return op; });
    });
  }
  template <class Visit>
  void with_fluid(const Visit& visit) const {
    if (parameters_.change)
      visit(ChangedFlow<Op>{faces_->op(), parameters_.change->response});
    else
      visit(faces_->op());
  }

  std::vector<Real> pressures(const assembly::State& state) const {
    const auto p = base::to_host(state.x[block_]);
    std::vector<Real> values;
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) values.push_back(p(mesh_->facets->fracture_face[f]));
    return values;
  }

  /// Values of(conduit, widening), [owned face].
  template <class Of>
  std::vector<Real> of_conduits(const assembly::State& state, const Of& of) const {
    View<Real*>::HostMirror widening("widening", mesh_->n_fracture_faces());
    if (widens_) Kokkos::deep_copy(widening, state.x[widening_]);
    std::vector<Real> values;
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f)
      values.push_back(of(parameters_.faces[f].along, widening(f)));
    return values;
  }
  std::vector<Real> apertures(const assembly::State& state) const {
    return of_conduits(state, [](const auto& along, Real widening) {
      return along.is_sealed(widening) ? 0 : along.hydraulic_aperture(widening);
    });
  }
  std::vector<Real> volumes(const assembly::State& state) const {
    return of_conduits(state, [](const auto& along, Real widening) { return along.mechanical_aperture(widening); });
  }

  std::vector<Real> fluxes(const assembly::State& state) const {
    const auto p = base::to_host(state.x[block_]);
    const auto widening = widens_ ? base::to_host(state.x[widening_]) : p;
    const auto& change = parameters_.change;
    const auto carried = change ? base::to_host(state.x[carried_]) : p;
    std::vector<Real> values;
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) {
      const Plane plane = faces_->plane(f);
      Real x[1 + n] = {p(mesh_->facets->fracture_face[f])}, q[n];
      for (int k = 0; k < n; ++k) x[1 + k] = p(mesh_->facets->ridge[f * n + k]);
      const Real u = carried(mesh_->facets->fracture_face[f]);
      auto flow = faces_->op().at(f);
      if (widens_) {
        Real rise[n];
        for (int k = 0; k < n; ++k) rise[k] = x[1 + k] - x[0];
        flow = flow.scaled(EndTransmissivities<n>(parameters_.faces[f].along, widening(f), rise).value);
      }
      flow.heavier(change ? change->response.density(u).value : 1).flow(x, q);
      const Real scale =
          (change ? change->response.mobility(u).value : 1) / (parameters_.fluid.density(x[0]) * plane.area);
      for (int i = 0; i < 3; ++i) {
        Real flux = 0;
        for (int k = 0; k < n; ++k) flux += q[k] * plane.d[k][i] * scale;
        values.push_back(flux);
      }
    }
    return values;
  }

  /// Pressure p with p T = flow, where T is the transmissivity of a conduit opened by p, by bisection. The initial T of
  /// a tight fracture would give a pressure that is far too high.
  Real pressure_for(Real flow, const laws::Conduit& conduit) const {
    Real low = 0, high = flow / conduit.transmissivity();
    for (int k = 0; k < 100 && parameters_.softness > 0; ++k) {
      const Real p = (low + high) / 2;
      (p * conduit.transmissivity(parameters_.softness * p) < flow ? low : high) = p;
    }
    return high;
  }

  bool is_linear() const { return parameters_.fluid.compressibility == 0 && !widens_ && !parameters_.change; }

  /// Calls visit(area, source) at the quadrature points of a face.
  template <class Visit>
  void for_each_source(LocalIndex f, Real t, const Visit& visit) const {
    const auto& face = mesh_->fracture_faces[f];
    const auto& source = parameters_.source[face.fracture];
    if (source.is_constant() && source({}, 0) == 0) return;
    assembly::for_each_face_point(*mesh_, face.cell[mesh::minus], face.local_face[mesh::minus],
                                  [&](const auto&, Real area, const auto& x) { visit(area, source(x, t)); });
  }

  /// Calls visit(condition, rim, length times aperture, x) for all fracture ends with a condition.
  template <class Visit>
  void for_each_end(const Visit& visit) const {
    for (std::size_t k = 0; k < outflow_.conditions().size(); ++k)
      for (const auto& rim : mesh_->facets->rims) {
        const auto& condition = outflow_.conditions()[k];
        if (condition.boundary != rim.boundary || condition.fracture != mesh_->fracture_faces[rim.face].fracture)
          continue;
        const Real aperture = parameters_.faces[rim.face].along.hydraulic_aperture();
        visit(k, rim, aperture * mesh::ridge_length(*mesh_, rim.face, rim.ridge),
              mesh::ridge_centre(*mesh_, rim.face, rim.ridge));
      }
  }

  FractureFlowParameters parameters_;
  bool widens_ = false;  // by "widening" of FractureOpening, on which T depends
  RCP<const mesh::Mesh> mesh_;
  int block_ = -1, widening_ = -1, carried_ = -1;  // face pressure, widening, field that changes the fluid
  Real size_ = 0;                                  // largest extent of the domain, m
  Real open_ = 0;                                  // aperture of a fracture with negligible pressure drop, m
  bool loaded_ = false;
  std::unique_ptr<FractureFaces<shape>> faces_;
  assembly::Term flow_;
  Outflow outflow_;      // through the ends of fractures
  assembly::Load load_;  // m^3/s
};

}  // namespace

std::unique_ptr<assembly::Module> make_fracture_flow(Shape shape, FractureFlowParameters parameters) {
  return mesh::for_face_corners(shape, [&](auto s) -> std::unique_ptr<assembly::Module> {
    return std::make_unique<FractureFlow<s()>>(std::move(parameters));
  });
}

}  // namespace sprekk::transport
