#include "physics/tracer/fracture_tracer.hpp"

#include "assembly/assembler.hpp"
#include "assembly/capabilities.hpp"
#include "mesh/facets.hpp"
#include "physics/tracer/rock_tracer.hpp"
#include "transport/face_plane.hpp"

namespace sprekk::physics {

using assembly::Loop;
using assembly::Slot;
using mesh::Shape;

namespace {

/// Storage and decay in a face. Advection supplies c dm/dt; this part is subtracted from d(m c)/dt with the same rates,
/// see assembly::Rates. The remaining storage is q (c - c_old) with q = now m_old + before (m_old - m_older).
///
/// | symbol | shape           | unit       |                       |
/// | x      | 1               | kg/m^3     | c of the face         |
/// | r      | 1               | kg/s       | (2D: kg/(m s))        |
/// | area   | [local face]    | m^2        | (2D: m)               |
/// | saved   | [owned face, 3] | kg/m^3, m  | c_old, m_old, m_older |
struct FillingTracer {
  using Columns = assembly::Slots<Slot<1, 1>>;
  using Rows = Columns;
  ConstView<Real*> area = {};
  View<Real**> saved = {};
  Real now = 0, before = 0, decay = 0;

  KOKKOS_INLINE_FUNCTION Real storage(int f) const {
    return area(f) * (now * saved(f, 1) + before * (saved(f, 1) - saved(f, 2)));
  }
  KOKKOS_INLINE_FUNCTION void residual(int f, const Real (&x)[1], Real (&r)[1]) const {
    r[0] = storage(f) * (x[0] - saved(f, 0)) + decay * area(f) * saved(f, 1) * x[0];
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int f, const Real (&)[1], Real (&J)[1][1]) const {
    J[0][0] = storage(f) + decay * area(f) * saved(f, 1);
  }
};

template <Shape shape>
class FractureTracer final : public assembly::Module,
                             public assembly::InitialValues,
                             public assembly::Steps,
                             public assembly::Totals {
 public:
  using Plane = transport::FacePlane<shape>;
  static constexpr int n = Plane::n;

  explicit FractureTracer(FractureTracerParameters parameters) : parameters_(std::move(parameters)) {}

  std::string name() const override { return "tracer in fractures"; }

  assembly::Declaration declare(const mesh::Mesh&) const override {
    assembly::Declaration d;
    d.couplings = {{Loop::fracture_cells, "face concentration", {"face concentration"}}};
    d.stores = true;
    d.history = {{"concentration, two fillings", fields::Entity::fracture_face, 3}};
    using assembly::Summary;
    d.outputs = {{{"fracture concentration",
                   "kg/m^3",
                   fields::Entity::fracture_face,
                   1,
                   {Summary::mean_and_max, "fracture concentration"}},
                  [this](const auto& state) { return concentrations(state); }}};
    return d;
  }

  void bind(const assembly::Context& context) override {
    mesh_ = context.mesh();
    concentration_ = context.field("face concentration");
    if (parameters_.fluid) pressure_ = context.field("face pressure");
    if (parameters_.widens) widening_ = context.field("widening");
    const std::vector<int> own = {concentration_};
    diffusion_assembler_ = std::make_unique<assembly::Assembler<Diffusion>>(
        context, Loop::fracture_cells, own, own, assembly::Assembler<Diffusion>::Positions::keep);
    filling_assembler_ = std::make_unique<assembly::Assembler<FillingTracer>>(
        context, Loop::fracture_faces, own, own, assembly::Assembler<FillingTracer>::Positions::keep);
    set_diffusion();
    set_filling();
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    diffusion_assembler_->add_residual(diffusion_, state, r);
    filling_assembler_->add_residual(filling(state), state, r);
  }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    diffusion_assembler_->add_jacobian(diffusion_, state, J);
    filling_assembler_->add_jacobian(filling(state), state, J);
  }

  void initial_history(const std::vector<View<Real**>>& history) const override {
    const auto saved = Kokkos::create_mirror_view(history[0]);
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) {
      const auto& face = parameters_.faces[f];
      const Real density = parameters_.fluid ? parameters_.fluid->density(start(f, parameters_.initial_pressure)) : 1;
      saved(f, 0) = start(f, parameters_.initial);
      saved(f, 1) = saved(f, 2) = face.at_start() * (density + face.retardation - 1);
    }
    Kokkos::deep_copy(history[0], saved);
  }

  void commit(assembly::State& state) const override {
    const auto saved = state.history[0];
    const auto facet = facet_;
    const auto aperture = aperture_, minimum = minimum_, sorbed = sorbed_;
    const auto c = state.x[concentration_];
    const auto p = pressure_ < 0 ? ConstView<Real*>() : state.x[pressure_];
    const auto widening = widening_ < 0 ? ConstView<Real*>() : state.x[widening_];
    const auto fluid = parameters_.fluid.value_or(laws::Fluid());
    const bool flows = pressure_ >= 0, widens = widening_ >= 0;
    Kokkos::parallel_for(
        "tracer in fractures", Kokkos::RangePolicy<Execution>(0, saved.extent(0)), KOKKOS_LAMBDA(int f) {
          const Real a = aperture(f) + (widens ? widening(f) : 0);
          saved(f, 0) = c(facet(f));
          saved(f, 2) = saved(f, 1);
          saved(f, 1) = (a > minimum(f) ? a : minimum(f)) * (flows ? fluid.density(p(facet(f))) : 1) + sorbed(f);
        });
  }

  void totals(const assembly::State& state, std::vector<assembly::Total>& totals) const override {
    const auto saved = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), state.history[0]);
    Real mass = 0, decay = 0;
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) {
      const Real amount = mesh_->fracture_faces[f].area * saved(f, 0);
      mass += amount * saved(f, 1);
      decay += parameters_.decay * amount * saved(f, 2);
    }
    add_tracer_totals(*mesh_, "in fractures", mass, decay, totals);
  }

 private:
  using Diffusion = transport::StoredFlow<n, assembly::Slots<Slot<1 + n, 1>>>;

  /// Mean over a face at the start.
  Real start(LocalIndex f, const base::Expression& value) const {
    const auto& face = mesh_->fracture_faces[f];
    return assembly::face_mean(*mesh_, face.cell[mesh::minus], face.local_face[mesh::minus],
                               [&](const auto&, const auto& x) { return value(x, 0); });
  }

  FillingTracer filling(const assembly::State& state) const {
    return {area_, state.history[0], state.rate, state.before, parameters_.decay};
  }

  std::vector<Real> concentrations(const assembly::State& state) const {
    const auto c = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), state.x[concentration_]);
    std::vector<Real> values;
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) values.push_back(c(mesh_->facets->fracture_face[f]));
    return values;
  }

  void set_diffusion() {
    const LocalIndex n_faces = mesh_->n_fracture_faces();
    View<Real**> T("T", n_faces, n * n);
    const auto host = Kokkos::create_mirror_view(T);
    for (LocalIndex f = 0; f < n_faces; ++f) {
      const auto& face = parameters_.faces[f];
      const Plane plane(*mesh_, f, face.at_start() * face.diffusion, parameters_.scheme);
      for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j) host(f, k * n + j) = plane.T[k][j];
    }
    Kokkos::deep_copy(T, host);
    diffusion_ = {.T = T, .lift = {}};
  }

  void set_filling() {
    std::vector<Real> area, aperture, minimum, sorbed;
    std::vector<LocalIndex> facet;
    for (std::size_t f = 0; f < parameters_.faces.size(); ++f) {
      const auto& face = parameters_.faces[f];
      area.push_back(mesh_->fracture_faces[f].area);
      aperture.push_back(face.aperture);
      minimum.push_back(face.minimum);
      sorbed.push_back((face.retardation - 1) * face.at_start());
      facet.push_back(mesh_->facets->fracture_face[f]);
    }
    area_ = assembly::to_device(area, "area");
    aperture_ = assembly::to_device(aperture, "aperture");
    minimum_ = assembly::to_device(minimum, "residual aperture");
    sorbed_ = assembly::to_device(sorbed, "sorbed");
    facet_ = assembly::to_device(facet, "facet");
  }

  FractureTracerParameters parameters_;
  RCP<const mesh::Mesh> mesh_;
  int concentration_ = -1, pressure_ = -1, widening_ = -1;  // blocks: face concentration, face pressure, widening
  ConstView<Real*> area_, aperture_, minimum_, sorbed_;     // [local fracture face] A, a_0, residual, (R - 1) a_0
  ConstView<LocalIndex*> facet_;                            // [local fracture face]
  Diffusion diffusion_;
  std::unique_ptr<assembly::Assembler<Diffusion>> diffusion_assembler_;
  std::unique_ptr<assembly::Assembler<FillingTracer>> filling_assembler_;
};

}  // namespace

std::unique_ptr<assembly::Module> make_fracture_tracer(Shape shape, FractureTracerParameters parameters) {
  return mesh::for_face_corners(shape, [&](auto s) -> std::unique_ptr<assembly::Module> {
    return std::make_unique<FractureTracer<s()>>(std::move(parameters));
  });
}

}  // namespace sprekk::physics
