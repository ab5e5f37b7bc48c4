#include "physics/heat/fracture_heat.hpp"

#include "assembly/assembler.hpp"
#include "assembly/capabilities.hpp"
#include "base/host_table.hpp"
#include "mesh/facets.hpp"
#include "transport/face_plane.hpp"

namespace sprekk::physics {

using assembly::Loop;
using assembly::Slot;
using mesh::Shape;

namespace {

/// Heat storage of the filling, whose amount m changes. Advection supplies T dm/dt; this part is subtracted from d(m
/// T)/dt with the same rates, see assembly::Rates. The remaining term is q (T - T_old) with q = now m_old + before
/// (m_old - m_older), minus the storage of the previous step.
///
/// | symbol | shape                | unit           |                                            |
/// | x      | 1                    | K              | T of the face                              |
/// | r      | n_rows               | W, m^3/s       | c A q (T - T_old), then -beta A q (T - T_old) |
/// | area   | [local face]         | m^2            | (2D: m)                                    |
/// | factor | [local face, n_rows] | J/(m^3 K), 1/K | c, -beta                                   |
/// | saved   | [owned face, 3]      | K, m, m        | T_old, m_old, m_older                      |
template <int n_rows>
struct Filling {
  using Columns = assembly::Slots<Slot<1, 1>>;
  using Rows = std::conditional_t<n_rows == 2, assembly::Slots<Slot<1, 1>, Slot<1, 1>>, Columns>;
  ConstView<Real*> area;
  ConstView<Real**> factor;
  View<Real**> saved;
  Real now = 0, before = 0;

  KOKKOS_INLINE_FUNCTION Real per_kelvin(int f, int k) const {
    return factor(f, k) * area(f) * (now * saved(f, 1) + before * (saved(f, 1) - saved(f, 2)));
  }
  KOKKOS_INLINE_FUNCTION void residual(int f, const Real (&x)[1], Real (&r)[n_rows]) const {
    for (int k = 0; k < n_rows; ++k) r[k] = per_kelvin(f, k) * (x[0] - saved(f, 0));
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int f, const Real (&)[1], Real (&J)[n_rows][1]) const {
    for (int k = 0; k < n_rows; ++k) J[k][0] = per_kelvin(f, k);
  }
};

template <Shape shape, bool expands>
class FractureHeat final : public assembly::Module, public assembly::InitialValues, public assembly::Steps {
 public:
  using Plane = transport::FacePlane<shape>;
  static constexpr int n = Plane::n;

  explicit FractureHeat(FractureHeatParameters parameters) : parameters_(std::move(parameters)) {}

  std::string name() const override { return "heat of fractures"; }

  assembly::Declaration declare(const mesh::Mesh&) const override {
    assembly::Declaration d;
    d.couplings = {{Loop::fracture_cells, "face temperature", {"face temperature"}}};
    if (expands) d.couplings.push_back({Loop::fracture_faces, "face pressure", {"face temperature"}});
    d.stores = true;
    d.history = {{"temperature, two fillings", fields::Entity::fracture_face, 3}};
    using assembly::Summary;
    d.outputs = {{{"fracture temperature",
                   "K",
                   fields::Entity::fracture_face,
                   1,
                   {Summary::mean_and_max, "fracture temperature"}},
                  [this](const auto& state) { return temperatures(state); }}};
    return d;
  }

  void bind(const assembly::Context& context) override {
    mesh_ = context.mesh();
    temperature_ = context.field("face temperature");
    if (parameters_.fluid) pressure_ = context.field("face pressure");
    if (parameters_.widens) widening_ = context.field("widening");
    const std::vector<int> own = {temperature_};
    conduction_assembler_ = std::make_unique<ConductionAssembler>(context, Loop::fracture_cells, own, own,
                                                                  ConductionAssembler::Positions::keep);
    filling_assembler_ = std::make_unique<FillingAssembler>(context, Loop::fracture_faces,
                                                            expands ? std::vector{temperature_, pressure_} : own, own,
                                                            FillingAssembler::Positions::keep);
    set_conduction();
    set_filling();
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    conduction_assembler_->add_residual(conduction_, state, r);
    filling_assembler_->add_residual(filling(state), state, r);
  }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    conduction_assembler_->add_jacobian(conduction_, state, J);
    filling_assembler_->add_jacobian(filling(state), state, J);
  }

  void initial_history(const std::vector<View<Real**>>& history) const override {
    const base::HostTable<Real**> saved(history[0]);
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) {
      saved(f, 0) = start(f, parameters_.initial);
      saved(f, 1) = parameters_.faces[f].at_start() * density_at(start(f, parameters_.initial_pressure), saved(f, 0));
      saved(f, 2) = saved(f, 1);
    }
    saved.on_device();
  }

  void commit(assembly::State& state) const override {
    const auto saved = state.history[0];
    const auto facet = facet_;
    const auto aperture = aperture_, minimum = minimum_;
    const auto T = state.x[temperature_];
    const auto p = pressure_ < 0 ? ConstView<Real*>() : state.x[pressure_];
    const auto widening = widening_ < 0 ? ConstView<Real*>() : state.x[widening_];
    const auto fluid = parameters_.fluid.value_or(laws::Fluid());
    const bool flows = pressure_ >= 0, widens = widening_ >= 0, changes = parameters_.change.has_value();
    const auto response = changes ? parameters_.change->response : laws::FluidResponse();
    Kokkos::parallel_for(
        "filling", Kokkos::RangePolicy<Execution>(0, saved.extent(0)), KOKKOS_LAMBDA(int f) {
          const Real a = aperture(f) + (widens ? widening(f) : 0);
          saved(f, 0) = T(facet(f));
          saved(f, 2) = saved(f, 1);
          saved(f, 1) = (a > minimum(f) ? a : minimum(f)) * (flows ? fluid.density(p(facet(f))) : 1) *
                        (changes ? response.density(saved(f, 0)).value : 1);
        });
  }

 private:
  using Conduction = transport::StoredFlow<n, assembly::Slots<Slot<1 + n, 1>>>;
  using ConductionAssembler = assembly::Assembler<Conduction>;
  using FillingAssembler = assembly::Assembler<Filling<expands ? 2 : 1>>;

  /// Mean over a face at the start.
  Real start(LocalIndex f, const base::Expression& value) const {
    const auto& face = mesh_->fracture_faces[f];
    return assembly::face_mean(*mesh_, face.cell[mesh::minus], face.local_face[mesh::minus],
                               [&](const auto&, const auto& x) { return value(x, 0); });
  }
  Real density_at(Real p, Real T) const {
    const auto& change = parameters_.change;
    return (parameters_.fluid ? parameters_.fluid->density(p) : 1) * (change ? change->response.density(T).value : 1);
  }

  Filling<expands ? 2 : 1> filling(const assembly::State& state) const {
    auto op = filling_;
    op.saved = state.history[0];
    op.now = state.rate;
    op.before = state.before;
    return op;
  }

  std::vector<Real> temperatures(const assembly::State& state) const {
    const auto T = base::to_host(state.x[temperature_]);
    std::vector<Real> values;
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) values.push_back(T(mesh_->facets->fracture_face[f]));
    return values;
  }

  void set_conduction() {
    const LocalIndex n_faces = mesh_->n_fracture_faces();
    const base::HostTable<Real**> T("T", n_faces, n * n);
    for (LocalIndex f = 0; f < n_faces; ++f) {
      const auto& face = parameters_.faces[f];
      const Plane plane(*mesh_, f, face.at_start() * face.conductivity, parameters_.scheme);
      for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j) T(f, k * n + j) = plane.T[k][j];
    }
    conduction_ = {.T = T.on_device(), .lift = {}};
  }

  void set_filling() {
    std::vector<Real> area, aperture, minimum;
    std::vector<LocalIndex> facet;
    const base::HostTable<Real**> factors("factor", parameters_.faces.size(), expands ? 2 : 1);
    for (std::size_t f = 0; f < parameters_.faces.size(); ++f) {
      area.push_back(mesh_->fracture_faces[f].area);
      aperture.push_back(parameters_.faces[f].aperture);
      minimum.push_back(parameters_.faces[f].minimum);
      facet.push_back(mesh_->facets->fracture_face[f]);
      factors(f, 0) = parameters_.faces[f].capacity;
      if (expands) factors(f, 1) = -parameters_.expansion;
    }
    filling_.area = assembly::to_device(area, "area");
    filling_.factor = factors.on_device();
    aperture_ = assembly::to_device(aperture, "aperture");
    minimum_ = assembly::to_device(minimum, "residual aperture");
    facet_ = assembly::to_device(facet, "facet");
  }

  FractureHeatParameters parameters_;
  RCP<const mesh::Mesh> mesh_;
  int temperature_ = -1, pressure_ = -1, widening_ = -1;  // blocks of face temperature, face pressure, widening
  ConstView<Real*> aperture_, minimum_;                   // [local fracture face] a_0, residual aperture, m
  ConstView<LocalIndex*> facet_;                          // [local fracture face]
  Conduction conduction_;
  Filling<expands ? 2 : 1> filling_;
  std::unique_ptr<ConductionAssembler> conduction_assembler_;
  std::unique_ptr<FillingAssembler> filling_assembler_;
};

}  // namespace

std::unique_ptr<assembly::Module> make_fracture_heat(Shape shape, FractureHeatParameters parameters) {
  return mesh::for_face_corners(shape, [&](auto s) -> std::unique_ptr<assembly::Module> {
    if (parameters.fluid && parameters.expansion > 0)
      return std::make_unique<FractureHeat<s(), true>>(std::move(parameters));
    return std::make_unique<FractureHeat<s(), false>>(std::move(parameters));
  });
}

}  // namespace sprekk::physics
