// Newton's method for one point of a joint.
#pragma once

#include "base/check.hpp"
#include "laboratory/point.hpp"
#include "laws/joint_quantities.hpp"
#include "laws/joint_slopes.hpp"
#include "laws/joint_start.hpp"

#include <Sacado.hpp>
#include <Teuchos_LAPACK.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace sprekk::laboratory {

inline constexpr const char* axes[] = {"n", "t1", "t2"};

/// Axis names: "n", then "t" in 2D, "t1" and "t2" in 3D.
inline const char* axis(std::size_t dim, std::size_t i) { return dim == 2 && i == 1 ? "t" : axes[i]; }

/// Newton's method for R(w, lambda) = 0 and one control equation per component. Unknowns are the jump w, m, and the
/// traction lambda, Pa, in the joint frame.
template <int dim>
struct JointPoint {
  static constexpr int samples = 32;  // points along the slip of a step
  static constexpr const char* not_converged = "Newton's method does not converge";
  static constexpr Real of_controls = 0;  // marks projection constants derived from the controls

  const PointPath& path;
  laws::Joint law;
  laws::Augmentation constants;
  std::vector<Real> history = std::vector<Real>(law.n_history(dim), 0);  // history variables of the law
  Real stiffness[dim], prescribed[dim] = {}, unknowns[2 * dim] = {}, last_plastic[dim - 1] = {};
  Real start_traction[dim] = {}, rest[dim] = {};  // initial traction and its jump
  Real unloaded_aperture;                         // a0 of (15), m
  Real time = 0, duration = 0;                    // end of the last step, length of the step to be solved, s
  std::vector<std::string> names;                 // of the reported quantities: those of laws with a slip rate
  std::vector<laws::QuantityOfFace> reported;     // their values
  mutable long evaluations = 0;

  JointPoint(const PointPath& along, const laws::JointParameters& joint)
      : path(along), law(joint.law), unloaded_aperture(joint.initial_aperture) {
    for (std::size_t i = 0; i < path.plastic_jump.size(); ++i) last_plastic[i] = path.plastic_jump[i];
    for (int i = 0; i < dim; ++i) stiffness[i] = i == 0 ? path.normal_stiffness : path.tangential_stiffness;
    law.sliding_compliance = 0;  // only used to steer the iteration on meshes
    if (law.depends_on_rate())
      for (const auto& quantity : laws::joint_quantities())
        if (auto value = laws::quantity_of(law, quantity.name)) {
          names.push_back(quantity.name);
          reported.push_back(std::move(value));
        }
    if (!path.initial_traction.empty()) press(joint);
  }

  /// Returns true if the tension prescribed at t exceeds the present strength: there is no state, the joint separates.
  bool is_pulled(Real t) const {
    const Real strength = law.is_bonded() ? law.cohesion(at_rest()).strength : 0;
    return control(0) == "traction" && path.path[0]({0, 0, 0}, t) > strength;
  }
  /// Sets a fully open joint without traction. The prescribed tangential jumps at t apply.
  void part(Real t) {
    for (int i = 0; i < dim; ++i) prescribed[i] = path.path[i]({0, 0, 0}, t);
    auto at = at_rest();
    at.open = true;
    at.separation = std::numeric_limits<Real>::max();
    for (int i = 1; i < dim; ++i) {
      if (control(i) == "jump") at.plastic_jump[i - 1] = rest[i] + prescribed[i];
      if (control(i) == "column") at.plastic_jump[i - 1] = rest[i] + prescribed[i] + start_traction[i] / stiffness[i];
    }
    Real now[dim - 1];
    std::copy_n(at.plastic_jump, dim - 1, now);
    at.slip_of_step = distance(now, last_plastic);
    at.plastic_slip = laws::norm(now);
    at.duration = t - time;
    law.commit(at, {history.data()});
    time = t;
    std::copy_n(now, dim - 1, last_plastic);
    std::fill_n(unknowns, 2 * dim, 0);
    std::copy_n(now, dim - 1, unknowns + 1);
  }

  /// Data changed by a step.
  struct Memory {
    Real x[2 * dim], plastic[dim - 1], time;
    std::vector<Real> saved;
  };
  Memory memory() const {
    Memory memory;
    std::copy_n(unknowns, 2 * dim, memory.x);
    std::copy_n(last_plastic, dim - 1, memory.plastic);
    memory.time = time;
    memory.saved = history;
    return memory;
  }
  void remember(const Memory& memory) {
    std::copy_n(memory.x, 2 * dim, unknowns);
    std::copy_n(memory.plastic, dim - 1, last_plastic);
    std::copy(memory.saved.begin(), memory.saved.end(), history.begin());
    time = memory.time;
  }

  static Real distance(const Real (&a)[dim - 1], const Real (&b)[dim - 1]) {
    Real difference[dim - 1];
    for (int i = 0; i < dim - 1; ++i) difference[i] = a[i] - b[i];
    return laws::norm(difference);
  }

  /// Sets the initial traction, the corresponding jump and the history variables. Throws an Error for tension above the
  /// strength, or for shear above the bound.
  void press(const laws::JointParameters& joint) {
    const auto traction = path.start_traction();
    const auto start = laws::start_of(joint, traction, dim);
    laws::check_start(joint, start, traction);
    std::copy_n(traction.begin(), dim, start_traction);
    std::copy_n(start.jump.begin(), dim, rest);
    std::copy_n(start.history.begin(), history.size(), history.begin());
    std::copy_n(rest, dim, unknowns);
    std::copy_n(start_traction, dim, unknowns + dim);
  }

  /// Sets x as if the prescribed values deform a bonded joint elastically, so intact states are tried before broken
  /// ones. Returns false if the joint has no bond or no elastic compliance.
  bool stretch() {
    bool stretched = false;
    for (int i = 0; i < dim && law.is_bonded(); ++i) {
      const Real compliance = i == 0 ? law.gap.closure.initial_compliance() : law.elastic.initial_compliance();
      if (compliance == 0) continue;
      if (control(i) == "jump") unknowns[dim + i] += (rest[i] + prescribed[i] - unknowns[i]) / compliance;
      if (control(i) == "traction") unknowns[i] += (prescribed[i] - unknowns[dim + i]) * compliance;
      stretched = true;
    }
    return stretched;
  }

  const std::string& control(int i) const { return path.control[i]; }

  /// Stiffness of the column, otherwise of the joint, otherwise the ratio of prescribed values; Pa/m.
  Real typical_stiffness() const {
    Real k = 0, length = 0, stress = 0;
    for (int i = 0; i < dim; ++i) {
      if (control(i) == "column") k = std::max(k, stiffness[i]);
      Real& size = control(i) == "traction" ? stress : length;
      size = std::max(size, std::abs(prescribed[i]));
    }
    for (const Real compliance : {law.elastic.initial_compliance(), law.gap.closure.initial_compliance()})
      if (k == 0 && compliance > 0) k = 1 / compliance;
    if (k == 0 && length > 0) k = stress / length;
    return k == 0 ? 1 : k;
  }

  /// Scales of jump, m, and traction, Pa, at x, for relative changes; c is a typical stiffness, Pa/m.
  void scales(Real c, Real (&scale)[2 * dim]) const {
    Real length = 1e-300;
    for (int i = 0; i < dim; ++i)
      length = std::max({length, std::abs(unknowns[i]), std::abs(unknowns[dim + i]) / c,
                         control(i) == "traction" ? std::abs(prescribed[i]) / c : std::abs(prescribed[i])});
    for (int i = 0; i < dim; ++i) {
      scale[i] = length;
      scale[dim + i] =
          std::max((i == 0 ? constants.normal : constants.tangential) * length, std::abs(unknowns[dim + i]));
    }
  }

  /// Projection constants (Pa/m) derived from the controls.
  /// * A column is in series with the joint: its stiffness.
  /// * A prescribed jump alone determines sliding or opening. |c_t (w - p_old)| is then much larger than any traction,
  ///   and c_n times the distance of the sides much larger than the bond strength.
  /// * A prescribed traction alone determines compression. c_n times the distance of the sides is much smaller than
  ///   this traction.
  laws::Augmentation augmentation_of_controls(Real c) const {
    constexpr Real far = 1e3;
    const auto bond = law.cohesion(at_rest());
    Real length = 1e-300, moved = 0, stress = std::max(bond.shear, bond.strength);
    bool slides = true, column = true;
    for (int i = 0; i < dim; ++i) {
      length = std::max({length, std::abs(unknowns[i]), std::abs(prescribed[i]) * (control(i) == "traction" ? 0 : 1)});
      stress = std::max(stress, std::abs(unknowns[dim + i]));
      if (i == 0) continue;
      moved = std::hypot(moved, unknowns[i] - last_plastic[i - 1]);
      slides = slides && control(i) == "jump";
      column = column && control(i) == "column";
    }
    Real c_t = column ? stiffness[1] : c;
    if (slides && moved > 0) c_t = far * std::max(c, stress / moved);
    Real c_n = control(0) == "column" ? stiffness[0] : c;
    if (control(0) == "jump") c_n = std::max(c, far * bond.strength / length);
    if (control(0) == "traction" && prescribed[0] < 0) c_n = std::min(c, -prescribed[0] / (far * length));
    return {laws::augmentation(law, c_n).normal, laws::augmentation(law, c_t).tangential};
  }

  /// Solves for the state at the prescribed values; returns the reason of a failure, or an empty text. The projection
  /// constants use the typical stiffness times the factor, or the controls. A damped step is halved until the residual
  /// decreases.
  std::string solve(Real factor, bool damped) {
    const Real c = typical_stiffness();
    for (int i = 0; i < dim; ++i) {
      if (control(i) == "jump") unknowns[i] = rest[i] + prescribed[i];
      if (control(i) == "traction") unknowns[dim + i] = prescribed[i];
    }
    constants = factor == of_controls ? augmentation_of_controls(c) : laws::augmentation(law, c * factor);
    Real f[2 * dim], J[4 * dim * dim], scale[2 * dim];
    for (int iteration = 0; iteration < 50; ++iteration) {
      const auto state = evaluate(f, J);
      scales(c, scale);
      const Real size = size_of(f, scale);
      int info = 0, pivots[2 * dim];
      Teuchos::LAPACK<int, Real>().GESV(2 * dim, 1, J, 2 * dim, pivots, f, 2 * dim, &info);
      Real change = 0, x[2 * dim], step[2 * dim];
      std::copy_n(unknowns, 2 * dim, x);
      std::copy_n(f, 2 * dim, step);
      for (int i = 0; i < 2 * dim; ++i) {
        if (info != 0 || !(std::abs(step[i]) < 1e10 * scale[i])) return undetermined(state);
        change = std::max(change, std::abs(step[i]) / scale[i]);
      }
      for (Real length = 1; length > 0.01; length /= 2) {
        for (int i = 0; i < 2 * dim; ++i) unknowns[i] = x[i] - length * step[i];
        if (!damped || change <= 1e-12) break;
        evaluate(f, J);
        if (size_of(f, scale) < size) break;
      }
      if (change <= 1e-12) return {};
    }
    return not_converged;
  }

  /// Norm of the residual, each entry divided by its scale.
  Real size_of(const Real (&f)[2 * dim], const Real (&scale)[2 * dim]) const {
    Real square = 0;
    for (int i = 0; i < dim; ++i) {
      const Real control_scale = control(i) == "jump" ? scale[i] : scale[dim + i];
      square += std::pow(f[i] / scale[dim + i], 2) + std::pow(f[dim + i] / control_scale, 2);
    }
    return std::sqrt(square);
  }

  /// Reason why the equations of a contact state do not determine jump and traction.
  std::string undetermined(laws::ContactState state) const {
    const bool pulled = std::count(path.control.begin() + 1, path.control.end(), "traction") > 0;
    const bool pressed = control(0) == "traction" && prescribed[0] < 0;
    if (state == laws::ContactState::open && !pressed) return "an open joint has no traction, its jump is unbounded";
    if (state == laws::ContactState::slip && pulled)
      return "the shear traction exceeds the friction bound, the joint slides without bound";
    if (control(0) == "jump" && law.gap.closure.initial_compliance() == 0)
      return "the faces touch and do not close, the normal jump does not determine the normal traction";
    return not_converged;
  }

  /// Returns true if the prescribed jump of a rigid joint equals that of the last step. Any traction below the friction
  /// bound is then admissible, and the joint retains its last traction.
  bool rests(int i) const {
    if (i == 0 || control(i) != "jump" || law.elastic.initial_compliance() > 0) return false;
    const Real jump = rest[i] + prescribed[i], last = last_plastic[i - 1];
    return std::abs(jump - last) <= 1e-14 * std::max(std::abs(jump), std::abs(last));
  }

  /// Computes f and its column-major Jacobian J at x.
  laws::ContactState evaluate(Real (&f)[2 * dim], Real (&J)[4 * dim * dim]) const {
    using Fad = Sacado::Fad::SFad<Real, 2 * dim>;
    ++evaluations;
    Fad w[dim], lambda[dim], R[dim];
    for (int i = 0; i < dim; ++i) {
      w[i] = Fad(2 * dim, i, unknowns[i]);
      lambda[i] = Fad(2 * dim, dim + i, unknowns[dim + i]);
    }
    const auto state =
        laws::contact_residual<dim>(law, constants, w, lambda, last_plastic, R, {history.data()}, duration);
    for (int i = 0; i < dim; ++i) {
      if (state == laws::ContactState::stick && rests(i)) R[i] = lambda[i] - unknowns[dim + i];
      const Fad moved = w[i] - rest[i];
      const Fad controlled = control(i) == "jump" ? Fad(moved - prescribed[i])
                             : control(i) == "traction"
                                 ? Fad(lambda[i] - prescribed[i])
                                 : Fad(lambda[i] - start_traction[i] - stiffness[i] * (prescribed[i] - moved));
      f[i] = R[i].val();
      f[dim + i] = controlled.val();
      for (int j = 0; j < 2 * dim; ++j) {
        J[j * 2 * dim + i] = R[i].dx(j);
        J[j * 2 * dim + dim + i] = controlled.dx(j);
      }
    }
    return state;
  }

  PointState accept(Real t) {
    Real f[2 * dim], J[4 * dim * dim];
    const auto contact = evaluate(f, J);
    Real w[dim], lambda[dim], elastic[dim], plastic[dim];
    std::copy_n(unknowns, dim, w);
    std::copy_n(unknowns + dim, dim, lambda);
    laws::split_jump<dim>(law, contact, w, lambda, last_plastic, elastic, plastic, {history.data()});
    if (contact == laws::ContactState::stick) {
      for (int i = 1; i < dim; ++i) plastic[i] = last_plastic[i - 1];
    }
    Real now[dim - 1];
    std::copy_n(plastic + 1, dim - 1, now);
    const auto at = laws::converged<dim>(law, contact, w, lambda, now, last_plastic, {history.data()}, duration,
                                         constants.tangential);
    const auto defect = law.defect_of_step(at);
    const bool jumps = contact == laws::ContactState::slip && runs_away(at);
    law.commit(at, {history.data()});
    std::copy_n(now, dim - 1, last_plastic);
    time = t;
    auto accepted = state(t, contact);
    accepted.slip_jumps = jumps;
    accepted.defect = defect;
    return accepted;
  }

  /// State with the present jump and traction, and the plastic jump of the last step.
  PointState state(Real t, laws::ContactState contact) const {
    Real w[dim], lambda[dim], elastic[dim], plastic[dim];
    std::copy_n(unknowns, dim, w);
    std::copy_n(unknowns + dim, dim, lambda);
    laws::split_jump<dim>(law, contact, w, lambda, last_plastic, elastic, plastic, {history.data()});
    std::copy_n(last_plastic, dim - 1, plastic + 1);
    return {t,
            contact,
            {w, w + dim},
            {elastic, elastic + dim},
            {plastic, plastic + dim},
            {lambda, lambda + dim},
            strength(lambda[0]),
            unloaded_aperture + w[0],
            quantities()};
  }

  /// Values of the reported quantities after the last step.
  std::vector<Real> quantities() const {
    std::vector<Real> values;
    for (const auto& value : reported) values.push_back(value(at_rest()));
    return values;
  }

  /// Bound of |lambda_t| at a normal traction after the slip so far, Pa.
  Real strength(Real lambda_n) const {
    auto at = at_rest();
    at.lambda_n = std::min(lambda_n, Real(0));
    return std::max(law.bound(at), Real(0));
  }

  /// Contact with the accumulated slip and no slip in the step.
  laws::Contact<Real> at_rest() const {
    laws::Contact<Real> at;
    at.dim = dim;
    at.history = {history.data()};
    at.plastic_slip = laws::norm(last_plastic);
    for (int i = 0; i < dim - 1; ++i) at.plastic_jump[i] = at.last_plastic_jump[i] = last_plastic[i];
    return at;
  }

  /// Returns true if friction decreases faster than column and joint unload, anywhere along the slip of the step. Then
  /// no continuous path of states connects its begin and end. Friction that depends on the slip rate has such a path.
  bool runs_away(const laws::Contact<Real>& end) const {
    if (law.depends_on_rate()) return false;
    const Real compliance = law.compliance(end) + (control(1) == "column" ? 1 / stiffness[1] : 0);
    for (int k = 0; k <= samples; ++k) {
      auto at = end;
      const Real part = Real(k) / samples;
      at.slip_of_step = part * end.slip_of_step;
      for (int i = 0; i < dim - 1; ++i)
        at.plastic_jump[i] = last_plastic[i] + part * (end.plastic_jump[i] - last_plastic[i]);
      at.plastic_slip = std::hypot(at.plastic_jump[0], at.plastic_jump[1]);
      if (laws::weakening(law, at) * compliance > 1) return true;
    }
    return false;
  }

  /// Message if the prescribed tension exceeds the tensile strength; otherwise empty.
  std::string beyond_strength() const {
    if (control(0) != "traction" || !law.is_bonded()) return "";
    const Real strength = law.cohesion(at_rest()).strength;
    if (!(strength > 0) || !(prescribed[0] > strength)) return "";
    return fmt::format("the tension of {:.6g} Pa exceeds the tensile strength, {:.6g} Pa now", prescribed[0], strength);
  }
};

}  // namespace sprekk::laboratory
