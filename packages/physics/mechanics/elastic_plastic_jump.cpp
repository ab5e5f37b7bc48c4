#include "physics/mechanics/elastic_plastic_jump.hpp"

#include "assembly/capabilities.hpp"
#include "assembly/geometry.hpp"
#include "base/host_table.hpp"
#include "base/over_ranks.hpp"
#include "laws/joint_slopes.hpp"
#include "laws/prescribed_jump.hpp"
#include "laws/joint_start.hpp"
#include "mesh/extents.hpp"
#include "physics/mechanics/joint_constraint.hpp"
#include "physics/mechanics/joint_operators.hpp"
#include "physics/mechanics/jump_outputs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprekk::physics {

using assembly::Loop;
using laws::ContactState;

std::vector<std::array<Real, 3>> initial_tractions(const mesh::Mesh& mesh, const InitialStress& stress,
                                                   const FluidPressure& fluid, Real time) {
  std::vector<std::array<Real, 3>> tractions(mesh.n_owned_fracture_faces);
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces && !stress.empty(); ++f) {
    const auto& face = mesh.fracture_faces[f];
    if (!stress.of_fracture.empty() && !stress.of_fracture[face.fracture].empty()) {
      const auto& given = stress.of_fracture[face.fracture];
      for (std::size_t k = 0; k < given.size(); ++k)
        tractions[f][k] = assembly::face_mean(mesh, face.cell[mesh::minus], face.local_face[mesh::minus],
                                              [&](const auto&, const auto& x) { return given[k](x, 0); });
      continue;
    }
    for (const int side : {mesh::minus, mesh::plus}) {
      const auto mean = mean_initial_traction(stress, mesh, face, side);
      for (int k = 0; k < mesh.dim(); ++k)
        for (int i = 0; i < mesh.dim(); ++i) tractions[f][k] += face.frame[k][i] * mean[i] / 2;
    }
    if (!fluid.empty()) tractions[f][0] += mean_bearing_pressure(fluid, mesh, f, mesh::minus, time);
  }
  return tractions;
}

namespace {

template <int dim>
class ElasticPlasticJump final : public assembly::Module,
                                 public assembly::Loads,
                                 public assembly::InitialValues,
                                 public assembly::Steps,
                                 public assembly::ContactFaces,
                                 public assembly::RowWeights,
                                 public assembly::Errors {
 public:
  using Points = laws::JointPoints<dim>;
  using Point = laws::JointPoint<dim>;

  ElasticPlasticJump(bool has_tips, ElasticPlasticJumpParameters parameters)
      : has_tips_(has_tips), parameters_(std::move(parameters)) {}

  std::string name() const override { return "elastic-plastic jump"; }

  void set_fields(const std::set<std::string>& fields) override { contains_fluid_ = fields.count("face pressure") > 0; }

  assembly::Declaration declare(const mesh::Mesh&) const override {
    assembly::Declaration d;
    assembly::Unknown traction{{"traction", fields::Entity::fracture_face, dim, "Pa"}, "stress", {{"stress"}}};
    traction.augmented_by = "displacement";
    traction.local_group = "fracture face";
    d.unknowns = {traction};
    d.couplings = {{Loop::fracture_faces, "traction", {"displacement", "side bubble", "traction"}}};
    if (has_tips_) d.couplings[0].columns.push_back("tip displacement");
    d.stores = dissipates();
    d.evolves = parameters_.depends_on_rate;
    if (dissipates()) d.couplings.push_back({Loop::fracture_faces, parameters_.power_to, d.couplings[0].columns});
    const auto face = fields::Entity::fracture_face;
    d.history = {{"plastic jump", face, dim - 1}, {"slid", face, 2}};
    declare_jump_outputs<dim>(
        parameters_, [this](const auto& state, const auto& use) { for_each_jump(state, use); }, d);
    if (parameters_.n_history > 0) {
      d.history.push_back({"history of laws", face, parameters_.n_history});
      d.history.push_back({"runaway slip", face, 1});
    }
    if (contains_fluid_) d.schur = {"face pressure"};
    return d;
  }

  void bind(const assembly::Context& context) override;
  assembly::Scales loads(Real t) const override;
  bool constant_load() const override {
    const auto& slips = parameters_.prescribed_slips;
    return std::all_of(slips.begin(), slips.end(), [](const auto& one) { return one.second.constant_in_time(); });
  }
  void set_time(Real t, const assembly::Scales&) override;
  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    operators_->add_residual(at(state), state, r);
    if (dissipates()) operators_->add_power(at(state), state, r);
  }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    Points points = at(state);
    points.damping = state.contact.damping;
    operators_->add_jacobian(points, state, J);
    if (dissipates()) operators_->add_power_jacobian(at(state), state, J);
  }
  void initial(const assembly::Rows& x) const override;
  void initial_history(const std::vector<View<Real**>>& history) const override;
  void commit(assembly::State& state) const override;
  void measure(const assembly::State& state, const assembly::Scales& scales,
               std::vector<fields::Measure>& measures) const override;
  void merit_weights(const assembly::Rows& weights) const override {
    Kokkos::deep_copy(weights[fields_[2]], merit_weight_);
  }
  void states(const assembly::State& state, std::vector<char>& states) const override {
    for_each_face(state, [&](LocalIndex f, const Point& point) { states[f] = static_cast<char>(point.state); });
  }
  void add_contact_constraints(const assembly::State& state,
                               std::vector<contact::Constraint>& constraints) const override;
  void step_errors(const assembly::State& begin, const assembly::State& end, fields::StepErrors& errors) const override;
  void add_schur(const assembly::State& state, const assembly::Rows& diagonals) const override;
  bool symmetric(const assembly::State& state) const override;

 private:
  /// Calls visit(face, point) for every owned face, on the host.
  template <class Visit>
  void for_each_face(const assembly::State& state, const Visit& visit) const {
    const auto points = operators_->evaluate(at(state), state);
    const auto host = base::to_host(points);
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) visit(f, host(f));
  }

  /// Joint laws with the history variables of `state`.
  Points at(const assembly::State& state) const {
    Points points = points_;
    points.p_old = state.history[0];
    if (parameters_.n_history > 0) points.stored_history = state.history[2];
    points.duration = state.dt;
    points.factor = state.contact.augmentation;
    points.proximal = state.contact.proximal;
    points.anchor = state.contact.anchor;
    return points;
  }

  bool is_prescribed(LocalIndex f) const {
    return !prescribed_.empty() && prescribed_[std::size_t(f) * dim + 1] != laws::not_prescribed;
  }
  bool dissipates() const { return !parameters_.power_to.empty(); }

  /// Returns a function of the face with the history variables of the laws, on the host.
  auto history_on_host(const assembly::State& state) const {
    Kokkos::View<Real**, Kokkos::LayoutRight, Kokkos::HostSpace> numbers;
    if (parameters_.n_history > 0) numbers = base::to_host(state.history[2]);
    return [numbers](LocalIndex f) {
      if (numbers.extent(1) == 0) return laws::History();
      return laws::History{&numbers(f, 0), static_cast<long>(numbers.stride(1))};
    };
  }

  /// Shear compliance of the rock at a face of a fracture of size L: L/G of the softer side, m/Pa; on the device.
  View<Real*> softness() const {
    std::vector<Real> all(mesh_->n_owned_fracture_faces);
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f)
      for (const LocalIndex cell : mesh_->fracture_faces[f].cell) {
        const Real G = elasticity(cell).G;
        all[f] = std::max(all[f], single_size_[mesh_->fracture_faces[f].single] / G);
      }
    return assembly::to_device(all, "softness");
  }
  const laws::JointParameters& joint(LocalIndex f) const { return parameters_.joints.of_face(*mesh_, f); }
  const laws::Elasticity& elasticity(LocalIndex cell) const { return parameters_.elasticity.of_cell(*mesh_, cell); }
  laws::JointStart start(LocalIndex f) const { return laws::start_of(joint(f), initial_tractions_[f], dim); }
  ConstView<Real**> initial_jump() const;  ///< w_0 [face, dim]
  void add_rate_errors(const assembly::State& end, fields::StepErrors& errors) const;
  void for_each_jump(const assembly::State& state, const std::function<void(const JumpOfFace<dim>&)>& use) const;
  void set_points();
  void set_sizes();

  bool has_tips_;
  ElasticPlasticJumpParameters parameters_;
  bool contains_fluid_ = false;  // the fluid pressure is unknown
  RCP<const mesh::Mesh> mesh_;
  std::vector<std::array<Real, 3>> initial_tractions_;  // [owned face] Pa
  std::vector<int> fields_;                             // displacement, side bubble, traction[, tip displacement]
  ConstView<laws::Joint*> laws_;
  Points points_;                 // without history variables
  std::vector<Real> prescribed_;  // as in prescribed_jumps()
  std::unique_ptr<JointOperators<dim>> operators_;
  View<Real*> softness_;           // [owned face]; only if laws have history variables
  View<Real*> merit_weight_;       // [owned row] compliance of a face, |f| h/(10 E): sum of weight R^2 is an energy
  std::vector<Real> modulus_;      // [owned face] Young's modulus of the softer side, Pa
  std::vector<Real> size_;         // [fracture] m
  std::vector<Real> single_size_;  // [single fracture] m, for unstable slip
  int pressure_ = -1;              // block of face pressures; only with unknown pressure
};

template <int dim>
ConstView<Real**> ElasticPlasticJump<dim>::initial_jump() const {
  if (parameters_.initial_stress.empty()) return {};
  const base::HostTable<Real**> rest("initial jump", mesh_->n_owned_fracture_faces, dim);
  for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) {
    const auto jump = start(f).jump;
    for (int k = 0; k < dim; ++k) rest(f, k) = jump[k];
  }
  return rest.on_device();
}

/// Sets the traction of the initial stress on closed faces.
template <int dim>
void ElasticPlasticJump<dim>::initial(const assembly::Rows& x) const {
  const base::HostTable<Real*> traction(x[fields_[2]]);
  for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) {
    const auto known = start(f).traction;
    for (int k = 0; k < dim; ++k) traction(f * dim + k) = known[k];
  }
  traction.on_device();
}

template <int dim>
void ElasticPlasticJump<dim>::initial_history(const std::vector<View<Real**>>& history) const {
  const base::HostTable<Real**> p(history[0]);
  for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f)
    for (int k = 0; k < dim - 1; ++k) p(f, k) = joint(f).plastic_jump[k];
  p.on_device();
  const auto& joints = parameters_.joints.values;
  if (parameters_.n_history == 0 || std::none_of(joints.begin(), joints.end(), [](auto& one) { return one.in_situ; }))
    return;
  const base::HostTable<Real**> of_laws(history[2]);
  for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) {
    const auto numbers = start(f).history;
    for (int k = 0; k < joint(f).law.n_history(dim); ++k) of_laws(f, k) = numbers[k];
  }
  of_laws.on_device();
}

/// Displacement scale: largest prescribed jump.
template <int dim>
assembly::Scales ElasticPlasticJump<dim>::loads(Real t) const {
  if (parameters_.prescribed_slips.empty()) return {};
  Real largest = 0;
  for (const Real jump : prescribed_jumps(parameters_.prescribed_slips, *mesh_, t))
    if (jump != laws::not_prescribed) largest = std::max(largest, std::abs(jump));
  return {{"displacement", largest}};
}

template <int dim>
void ElasticPlasticJump<dim>::set_time(Real t, const assembly::Scales&) {
  if (parameters_.prescribed_slips.empty() || (points_.prescribed.extent(0) > 0 && constant_load())) return;
  prescribed_ = prescribed_jumps(parameters_.prescribed_slips, *mesh_, t);
  const base::HostTable<Real**> prescribed("prescribed jump", mesh_->n_owned_fracture_faces, dim);
  for (std::size_t k = 0; k < prescribed_.size(); ++k)
    prescribed(static_cast<LocalIndex>(k / dim), k % dim) = prescribed_[k];
  points_.prescribed = prescribed.on_device();
}

template <int dim>
void ElasticPlasticJump<dim>::bind(const assembly::Context& context) {
  mesh_ = context.mesh();
  initial_tractions_ =
      initial_tractions(*mesh_, parameters_.initial_stress, parameters_.fluid_pressure, parameters_.start);
  fields_ = {context.field("displacement"), context.field("side bubble"), context.field("traction")};
  if (has_tips_) fields_.push_back(context.field("tip displacement"));
  if (contains_fluid_) pressure_ = context.field("face pressure");
  for (const auto& extents : mesh::fracture_extents(*mesh_)) size_.push_back(mesh::norm(extents));
  for (const auto& extents : mesh::single_fracture_extents(*mesh_)) single_size_.push_back(mesh::norm(extents));
  const int power_to = dissipates() ? context.field(parameters_.power_to) : -1;
  operators_ = make_joint_operators<dim>(context, fields_, power_to, initial_jump());
  set_points();
  set_sizes();
  if (parameters_.n_history > 0) softness_ = softness();
}

template <int dim>
void ElasticPlasticJump<dim>::set_points() {
  std::vector<laws::Joint> laws;
  for (const auto& joint : parameters_.joints.values) laws.push_back(joint.law);
  std::vector<int> number;
  const base::HostTable<Real***> frame("frame", mesh_->n_owned_fracture_faces, dim, dim);
  for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) {
    number.push_back(parameters_.joints.number_of(f, mesh_->fracture_faces[f].fracture));
    for (int k = 0; k < dim; ++k)
      for (int i = 0; i < dim; ++i) frame(f, k, i) = mesh_->fracture_faces[f].frame[k][i];
  }
  points_.frame = frame.on_device();
  laws_ = assembly::to_device(laws, "law");
  points_.law = laws_.data();
  points_.number = assembly::to_device(number, "number");
}

/// Computes the augmentation, Young's modulus of the softer side, and the weights of the merit.
template <int dim>
void ElasticPlasticJump<dim>::set_sizes() {
  std::vector<Real> augmentation, weight;
  for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) {
    const auto& face = mesh_->fracture_faces[f];
    Real modulus = std::numeric_limits<Real>::max(), height = 0;  // height of the cells
    for (const LocalIndex cell : face.cell) {
      modulus = std::min(modulus, elasticity(cell).youngs_modulus());
      assembly::for_each_cell_point(*mesh_, cell, [&](Real volume, const auto&) { height += volume / face.area / 2; });
    }
    modulus_.push_back(modulus);
    augmentation.push_back(parameters_.augmentation * modulus / size_[face.fracture]);
    weight.insert(weight.end(), dim, face.area * height / (10 * modulus));
  }
  merit_weight_ = assembly::to_device(weight, "weight");
  points_.augmentation = assembly::to_device(augmentation, "augmentation");
}

template <int dim>
void ElasticPlasticJump<dim>::commit(assembly::State& state) const {
  const Points points = at(state);
  const laws::JointHistory history{.plastic_jump = state.history[0],
                                   .slid = state.history[1],
                                   .runaway = parameters_.n_history > 0 ? state.history[3] : View<Real**>(),
                                   .softness = softness_};
  const auto end = operators_->evaluate(points, state);
  Kokkos::parallel_for(
      "commit", Kokkos::RangePolicy<Execution>(0, end.extent(0)),
      KOKKOS_LAMBDA(int f) { points.commit(f, end(f), history); });
}

/// Errors of slip that depends on its rate: relative error of the slip rate, weighted by the slip of the step, and of
/// the state variable, weighted by the compression; error of the growth of instabilities, the largest of all faces.
/// Unknown in the first step, which has no rate before it.
template <int dim>
void ElasticPlasticJump<dim>::add_rate_errors(const assembly::State& end, fields::StepErrors& errors) const {
  const auto history = history_on_host(end);
  std::vector<Real> sums(5, 0);  // slip, slip times error, force, force times error, faces without estimate
  Real growth = 0;
  for_each_face(end, [&](LocalIndex f, const Point& point) {
    const auto& law = joint(f).law;
    if (point.state == ContactState::open || !law.depends_on_rate() || is_prescribed(f)) return;
    Real p[dim - 1] = {};
    const Real compliance = law.compliance(laws::contact<dim>(point.traction[0], Real(0), p, point.p_old, history(f)));
    for (int k = 1; k < dim; ++k) p[k - 1] = point.w[k] - compliance * point.traction[k];
    const Real c_t = laws::augmentation(law, point.constant).tangential;
    const auto at =
        laws::converged<dim>(law, point.state, point.w, point.traction, p, point.p_old, history(f), end.dt, c_t);
    const auto defect = law.defect_of_step(at);
    const Real area = mesh_->fracture_faces[f].area, force = -area * point.traction[0];
    if (defect.rate < 0) sums[4] += 1;
    sums[0] += area * at.slip_of_step;
    sums[1] += area * at.slip_of_step * defect.rate;
    sums[2] += force;
    sums[3] += force * defect.state;
    growth = std::max(growth, defect.growth);
  });
  errors.push_back({"growth of instabilities", base::max_over_ranks(*mesh_->comm, growth), 3});
  sums = base::sum_over_ranks(*mesh_->comm, sums);
  const bool is_known = sums[4] == 0;
  const Real order = is_known ? 3 : fields::StepError::unknown;
  errors.push_back({"slip rate", is_known && sums[0] > 0 ? sums[1] / sums[0] : 0, order});
  errors.push_back({"friction state", is_known && sums[2] > 0 ? sums[3] / sums[2] : 0, order});
}

/// Error of the slip direction. Slip follows the traction at the end of the step, but the traction rotates during the
/// step. For an angle alpha between the tractions at both ends, the relative error is about sin(alpha)/2; it is zero
/// for a reversal along the same line. Mean over faces that have slid, weighted by their shear forces.
template <int dim>
void ElasticPlasticJump<dim>::step_errors(const assembly::State& begin, const assembly::State& end,
                                          fields::StepErrors& errors) const {
  if (parameters_.depends_on_rate) add_rate_errors(end, errors);
  if (dim == 2) return;
  const auto before = base::to_host(begin.x[fields_[2]]);
  std::vector<Real> sums(2, 0);  // of force times error, and of force
  for_each_face(end, [&](LocalIndex f, const Point& point) {
    const bool slides = point.state == ContactState::slip;
    if (point.state == ContactState::open || (!slides && laws::norm(point.p_old) == 0)) return;
    const Real *was = &before(f * dim + 1), *now = &point.traction[1];
    const Real force = mesh_->fracture_faces[f].area * std::hypot(now[0], now[1]);
    const Real sizes = std::hypot(was[0], was[1]) * std::hypot(now[0], now[1]);
    sums[1] += force;
    if (slides && sizes > 0) sums[0] += force * std::abs(was[0] * now[1] - was[1] * now[0]) / sizes / 2;
  });
  sums = base::sum_over_ranks(*mesh_->comm, sums);
  errors.push_back({"direction of slip", sums[1] > 0 ? sums[0] / sums[1] : 0, 1});
}

/// Measures the split of the jump. |R| in the traction scale is insensitive to soft joints. Therefore |R_n|/c_n of
/// closed faces and |R_t|/c_t of sticking and sliding faces are measured in the displacement scale, minus the rounding
/// error of the jump. Slow slip of a step may be much smaller than displacements. If friction depends on the slip rate,
/// |R_t|/c_t relative to the slip of the step is also measured; 1e-5 corresponds to the measure 1e-11.
template <int dim>
void ElasticPlasticJump<dim>::measure(const assembly::State& state, const assembly::Scales& scales,
                                      std::vector<fields::Measure>& measures) const {
  constexpr Real weight = 1e-6;
  Real largest = 0, of_slip = 0;
  const auto history = history_on_host(state);
  for_each_face(state, [&](LocalIndex f, const Point& point) {
    if (point.state == ContactState::open) return;
    const auto& law = joint(f).law;
    const laws::Contact<Real> at{
        .lambda_n = point.traction[0], .dim = dim, .history = history(f), .duration = state.dt};
    const bool rated = state.dt > 0 && law.depends_on_rate() && !is_prescribed(f);
    auto c = laws::augmentation(law, point.constant, point.spring);
    if (rated) c.tangential = laws::rated_constant(law, at, c.tangential);
    const Real compliance = rated ? law.compliance(at) : 0;
    Real square = 0, slip = 0;
    for (int i = 1; i < dim; ++i) {
      square += point.R[i] * point.R[i];
      const Real step = point.w[i] - compliance * point.traction[i] - point.p_old[i - 1];
      slip += std::pow(step + point.R[i] / c.tangential, 2);
    }
    const Real error = std::sqrt(square) / c.tangential - point.rounding;
    if (rated && point.state == ContactState::slip && slip > 0 && !(error * weight <= of_slip * std::sqrt(slip)))
      of_slip = error * weight / std::sqrt(slip);
    const Real size = std::max(std::abs(point.R[0]) / c.normal - point.rounding, error);
    if (!(size <= largest)) largest = size;
  });
  measures.push_back({"split of the jump", largest / scales.at("displacement")});
  if (parameters_.depends_on_rate) measures.push_back({"slip of the step", of_slip});
}

template <int dim>
void ElasticPlasticJump<dim>::add_contact_constraints(const assembly::State& state,
                                                      std::vector<contact::Constraint>& constraints) const {
  const auto history = history_on_host(state);
  for_each_face(state, [&](LocalIndex f, const Point& point) {
    constraints[f].modulus = modulus_[f];
    add_constraint<dim>(joint(f).law, mesh_->fracture_faces[f].frame, point, history(f), is_prescribed(f),
                        constraints[f]);
  });
}

/// Adds the fracture compliance of open faces. A fluid pressure p opens a fracture of size L by about 0.4 L/E p. This
/// is two thirds of the maximum opening 16/(3 pi) (1 - nu^2) (L/3)/E p of a disc of radius L/3 (Sneddon 1946).
template <int dim>
void ElasticPlasticJump<dim>::add_schur(const assembly::State& state, const assembly::Rows& diagonals) const {
  const auto rows = Kokkos::create_mirror_view(diagonals[pressure_]);
  Kokkos::deep_copy(rows, diagonals[pressure_]);
  for_each_face(state, [&](LocalIndex f, const Point& point) {
    if (point.state != ContactState::open) return;
    const auto& face = mesh_->fracture_faces[f];
    const Real softness = 0.4 * size_[face.fracture] / modulus_[f];
    rows(mesh_->facets->fracture_face[f]) += face.area * softness * state.rate;
  });
  Kokkos::deep_copy(diagonals[pressure_], rows);
}

/// Returns whether all face matrices are symmetric. Slip, and elasticity that depends on the normal traction, make them
/// non-symmetric. A softening bond makes them indefinite.
template <int dim>
bool ElasticPlasticJump<dim>::symmetric(const assembly::State& state) const {
  bool symmetric = true;
  const auto history = history_on_host(state);
  for_each_face(state, [&](LocalIndex f, const Point& point) {
    if (point.state == ContactState::open) return;
    const auto& law = joint(f).law;
    const Real p[dim - 1] = {};
    const auto at = laws::contact<dim>(point.traction[0], Real(0), p, point.p_old, history(f));
    const bool pulled = point.traction[0] > 0 && law.bond.n_history() > 0;
    if (point.state == ContactState::slip || pulled || laws::compliance_slope(law, at) != 0) symmetric = false;
  });
  return symmetric;
}

template <int dim>
void ElasticPlasticJump<dim>::for_each_jump(const assembly::State& state,
                                            const std::function<void(const JumpOfFace<dim>&)>& use) const {
  const auto host = [&](int k) { return base::to_host(state.history[k]); };
  const bool has_kept = parameters_.n_history > 0;
  const auto slid = host(1), runaway = host(has_kept ? 3 : 1);
  const auto history = history_on_host(state);
  for_each_face(state, [&](LocalIndex f, const Point& point) {
    const auto& face = mesh_->fracture_faces[f];
    JumpOfFace<dim> jump(face, point, joint(f), slid(f, 0) == 1, history(f), is_prescribed(f));
    jump.has_slipped = slid(f, 0) > 0;
    jump.friction_work = slid(f, 1);
    jump.number = parameters_.joints.number_of(f, face.fracture);
    jump.shear_modulus = (elasticity(face.cell[0]).G + elasticity(face.cell[1]).G) / 2;
    if (has_kept) jump.runaway = runaway(f, 0);
    use(jump);
  });
}

}  // namespace

std::unique_ptr<assembly::Module> make_elastic_plastic_jump(const mesh::Mesh& mesh,
                                                            ElasticPlasticJumpParameters parameters) {
  const bool has_tips = mesh::order(mesh.shape) == 1 && mesh.n_global_enriched > 0;
  if (mesh.dim() == 2) return std::make_unique<ElasticPlasticJump<2>>(has_tips, std::move(parameters));
  return std::make_unique<ElasticPlasticJump<3>>(has_tips, std::move(parameters));
}

}  // namespace sprekk::physics
