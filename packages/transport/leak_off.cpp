#include "transport/leak_off.hpp"

#include "assembly/assembler.hpp"
#include "assembly/capabilities.hpp"
#include "base/host_table.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::transport {

using assembly::Loop;

namespace {

/// Components of the history.
enum Component { lost, rate_of_step, n_components };

/// Loss of fluid of a face.
///
/// | symbol  | shape     | unit    |                                                                               |
/// | x       | 1         | m       | widening b; without widening any unknown                                      |
/// | r       | 1         | m^3/s   | rate |f| s (V(t + dt) - V(t))                                                 |
/// | factor  | [face]    | m/s^0.5 | 4 C_L                                                                         |
/// | area    | [face]    | m^2     | |f|                                                                           |
/// | initial | [face]    | m       | aperture at the start                                                         |
/// | closing | [face]    | m       | residual aperture; 0: s = 1                                                   |
/// | first   | [face]    | -       | part of the step in which the loss begins                                     |
/// | history | [face, 2] | m, m/s  | lost volume V per area; its mean rate in the last step                        |
/// | rate    |           | 1/s     | of assembly::State, as dt                                                     |
struct LeakingFace {
  using Columns = assembly::Slots<assembly::Slot<1, 1>>;
  using Rows = Columns;
  ConstView<Real*> factor, area, initial, closing, first;
  ConstView<Real**> history;
  Real rate = 0, dt = 0;

  KOKKOS_INLINE_FUNCTION Real aperture(int f, Real widening) const { return initial(f) + widening; }
  /// Share s of the loss.
  KOKKOS_INLINE_FUNCTION Real share(int f, Real widening) const {
    if (!(closing(f) > 0)) return 1;
    const Real a = aperture(f, widening);
    return a >= closing(f) ? 1 : a > 0 ? a / closing(f) : 0;
  }
  /// Exposure time with the lost volume, s.
  KOKKOS_INLINE_FUNCTION Real exposure(int f) const {
    const Real root = factor(f) > 0 ? history(f, lost) / factor(f) : 0;
    return root * root;
  }
  /// Loss per area in the step with s = 1, m.
  KOKKOS_INLINE_FUNCTION Real loss(int f) const {
    if (!(dt > 0)) return 0;
    constexpr Real rounding = 1e-12;  // of exposure times
    const Real age = exposure(f), more = age > rounding * dt ? dt : first(f) * dt;
    return factor(f) * more / (std::sqrt(age + more) + std::sqrt(age));
  }
  KOKKOS_INLINE_FUNCTION void residual(int f, const Real (&x)[1], Real (&r)[1]) const {
    r[0] = rate * area(f) * loss(f) * share(f, x[0]);
  }
  /// Within the rounding error of the widening, the derivative is that of an opening face.
  KOKKOS_INLINE_FUNCTION void jacobian(int f, const Real (&x)[1], Real (&J)[1][1]) const {
    constexpr Real rounding = 1e-9;  // of the residual aperture
    const Real a = aperture(f, x[0]);
    J[0][0] = a > -rounding * closing(f) && a < closing(f) ? rate * area(f) * loss(f) / closing(f) : 0;
  }
};

class LeakOff final : public assembly::Module, public assembly::Steps, public assembly::Totals {
 public:
  LeakOff(std::vector<FractureFlowParameters::Face> faces, bool widens) : faces_(std::move(faces)), widens_(widens) {}

  std::string name() const override { return "leak-off"; }

  assembly::Declaration declare(const mesh::Mesh& mesh) const override {
    using assembly::Summary;
    constexpr auto faces = fields::Entity::fracture_face;
    const bool flat = mesh.dim() == 2;
    assembly::Declaration d;
    d.couplings = {{Loop::fracture_faces, "face pressure", {column()}}};
    d.stores = true;
    d.history = {{"lost volume, rate", faces, n_components}};
    d.outputs = {{{"leaked fluid", "m", faces, 1}, [this](const auto& state) { return component(state, lost); }},
                 {{"leaked volume", "m", faces, 1, {Summary::integral, "leaked volume", "", {}, flat ? "m^2" : "m^3"}},
                  [this](const auto& state) { return component(state, lost); }},
                 {{"exposure time", "s", faces, 1}, [this](const auto& state) { return exposures(state); }}};
    return d;
  }

  void bind(const assembly::Context& context) override {
    mesh_ = context.mesh();
    std::vector<Real> factor, area, initial, closing, first;
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) {
      const auto& conduit = faces_[f].along;
      factor.push_back(4 * faces_[f].leak_off);
      area.push_back(mesh_->fracture_faces[f].area);
      initial.push_back(conduit.aperture);
      closing.push_back(widens_ ? conduit.minimum : 0);
      first.push_back(conduit.film > 0 ? 0.5 : 1);
    }
    face_.factor = assembly::to_device(factor, "4 C_L");
    face_.area = assembly::to_device(area, "area");
    face_.initial = assembly::to_device(initial, "aperture");
    face_.closing = assembly::to_device(closing, "residual aperture");
    face_.first = assembly::to_device(first, "part of the first step");
    assembler_ = std::make_unique<Assembler>(context, Loop::fracture_faces, std::vector{context.field("face pressure")},
                                             std::vector{context.field(column())}, Assembler::Positions::keep);
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    assembler_->add_residual(at(state), state, r);
  }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    assembler_->add_jacobian(at(state), state, J);
  }

  void commit(assembly::State& state) const override {
    const auto face = at(state);
    const auto saved = state.history[0];
    assembler_->for_each(
        face, state, KOKKOS_LAMBDA(int f, const Real(&x)[1]) {
          const Real loss = face.loss(f) * face.share(f, x[0]);
          saved(f, lost) += loss;
          saved(f, rate_of_step) = face.dt > 0 ? loss / face.dt : 0;
        });
  }

  void totals(const assembly::State& state, std::vector<assembly::Total>& totals) const override {
    totals.push_back({{"inflows", "leak-off"}, 0, mesh_->dim() == 2 ? "m^2/s" : "m^3/s"});
    const auto rates = component(state, rate_of_step);
    for (std::size_t f = 0; f < rates.size(); ++f) totals.back().value -= mesh_->fracture_faces[f].area * rates[f];
  }

 private:
  using Assembler = assembly::Assembler<LeakingFace>;

  std::string column() const { return widens_ ? "widening" : "face pressure"; }

  LeakingFace at(const assembly::State& state) const {
    auto face = face_;
    face.history = state.history[0];
    face.rate = state.rate;
    face.dt = state.dt;
    return face;
  }

  /// Values of a component of the history, [owned face].
  std::vector<Real> component(const assembly::State& state, int k) const {
    const auto saved = base::to_host(state.history[0]);
    std::vector<Real> values;
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) values.push_back(saved(f, k));
    return values;
  }
  std::vector<Real> exposures(const assembly::State& state) const {
    auto values = component(state, lost);
    for (std::size_t f = 0; f < values.size(); ++f)
      if (const Real factor = 4 * faces_[f].leak_off; factor > 0) values[f] = std::pow(values[f] / factor, 2);
    return values;
  }

  std::vector<FractureFlowParameters::Face> faces_;  // [local fracture face]
  bool widens_;
  RCP<const mesh::Mesh> mesh_;
  LeakingFace face_;
  std::unique_ptr<Assembler> assembler_;
};

}  // namespace

std::unique_ptr<assembly::Module> make_leak_off(std::vector<FractureFlowParameters::Face> faces, bool widens) {
  return std::make_unique<LeakOff>(std::move(faces), widens);
}

}  // namespace sprekk::transport
