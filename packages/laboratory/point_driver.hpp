// Newton's method for one point of a joint, step by step along a path.
#pragma once

#include "base/check.hpp"
#include "base/text.hpp"
#include "laboratory/point.hpp"
#include "physics/mechanics/elastic_plastic_jump.hpp"
#include "physics/mechanics/joint_material.hpp"
#include "physics/mechanics/joint_slopes.hpp"

#include <Sacado.hpp>
#include <Teuchos_LAPACK.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprekk::laboratory {

inline constexpr const char* axes[] = {"n", "t1", "t2"};

/// Axis names: "n", then "t" in 2D, "t1" and "t2" in 3D.
inline const char* axis(std::size_t dim, std::size_t i) { return dim == 2 && i == 1 ? "t" : axes[i]; }

/// Newton's method for R(w, lambda) = 0 and one control equation per component. Unknowns are the jump w, m, and the
/// traction lambda, Pa, in the joint frame.
template <int dim>
class PointDriver {
 public:
  PointDriver(const PointPath& point, const physics::Material& material)
      : point_(point), law_(material.joint({0, 0, 0}).law) {
    for (std::size_t i = 0; i < point_.plastic_jump.size(); ++i) p_old_[i] = point_.plastic_jump[i];
    for (int i = 0; i < dim; ++i) stiffness_[i] = i == 0 ? point_.normal_stiffness : point_.tangential_stiffness;
    law_.sliding_compliance = 0;  // only used to steer the iteration on meshes
    if (!point_.initial_traction.empty()) press();
  }

  /// State before the first step: without traction, or under the initial traction.
  PointState initial(Real t) {
    Real f[2 * dim], J[4 * dim * dim];
    c_ = laws::augmentation(law_, typical_stiffness());
    return state(t, evaluate(f, J));
  }

  /// Advances from the last time `from` to t, s. Returns one state, or also those before and after each slip jump.
  /// Throws an Error if no state is found.
  std::vector<PointState> advance(Real from, Real t) {
    std::vector<PointState> states;
    for (int jumps = 0; jumps < most_jumps; ++jumps) {
      const Memory begin = memory();
      const auto next = step_or_last(from, t);
      const Memory end = memory();
      const Real least = least_jump * distance(begin.plastic, end.plastic);
      beyond_ = next.slip_jumps ? std::vector<Real>(end.x, end.x + 2 * dim) : std::vector<Real>();
      const auto jump = next.slip_jumps ? jump_of_slip(begin, from, t, least) : Jump{};
      beyond_.clear();
      if (!(jump.size > least)) {
        remember(end);
        states.push_back(next);
        return states;
      }
      if (jump.from > from) states.push_back(jump.before);
      states.push_back(jump.after);
      if (jump.to == t) return states;
      from = jump.to;
    }
    states.push_back(step(t));
    return states;
  }

  /// Returns true if the tension prescribed at t exceeds the present strength: there is no state, the joint separates.
  bool is_pulled(Real t) const {
    const Real strength = law_.is_bonded() ? law_.cohesion(at_rest()).strength : 0;
    return control(0) == "traction" && point_.path[0]({0, 0, 0}, t) > strength;
  }
  /// Sets a fully open joint without traction. The prescribed tangential jumps at t apply.
  void part(Real t) {
    for (int i = 0; i < dim; ++i) d_[i] = point_.path[i]({0, 0, 0}, t);
    auto at = at_rest();
    at.open = true;
    at.separation = std::numeric_limits<Real>::max();
    for (int i = 1; i < dim; ++i) {
      if (control(i) == "jump") at.plastic_jump[i - 1] = rest_[i] + d_[i];
      if (control(i) == "column") at.plastic_jump[i - 1] = rest_[i] + d_[i] + base_[i] / stiffness_[i];
    }
    Real now[dim - 1];
    std::copy_n(at.plastic_jump, dim - 1, now);
    at.slip_of_step = distance(now, p_old_);
    at.plastic_slip = laws::norm(now);
    law_.commit(at, {kept_.data()});
    std::copy_n(now, dim - 1, p_old_);
    std::fill_n(x_, 2 * dim, 0);
    std::copy_n(now, dim - 1, x_ + 1);
  }

  /// Number of law evaluations with derivatives, one per residual evaluation.
  long evaluations() const { return evaluations_; }

 private:
  static constexpr int most_jumps = 8;      // slip jumps per step
  static constexpr Real resolution = 1e-9;  // of the time of a slip jump, relative to the step
  static constexpr Real least_jump = 1e-6;  // relative to the slip of the step
  static constexpr int samples = 32;        // points along the slip of a step
  static constexpr const char* not_converged = "Newton's method does not converge";
  static constexpr Real of_controls = 0;  // marks projection constants derived from the controls

  /// Data changed by a step.
  struct Memory {
    Real x[2 * dim], plastic[dim - 1];
    std::vector<Real> kept;
  };
  Memory memory() const {
    Memory memory;
    std::copy_n(x_, 2 * dim, memory.x);
    std::copy_n(p_old_, dim - 1, memory.plastic);
    memory.kept = kept_;
    return memory;
  }
  void remember(const Memory& memory) {
    std::copy_n(memory.x, 2 * dim, x_);
    std::copy_n(memory.plastic, dim - 1, p_old_);
    std::copy(memory.kept.begin(), memory.kept.end(), kept_.begin());
  }

  /// Slip jump between two adjacent times.
  struct Jump {
    Real from = 0, to = 0, size = 0;
    PointState before = {}, after = {};
  };

  /// Finds the first jump larger than `least` between the state `begin` at the time `from` and t. Afterwards the driver
  /// is at the state after the jump. The time is found by bisection; there is no slip jump before it.
  Jump jump_of_slip(const Memory& begin, Real from, Real t, Real least) {
    Jump jump{from, t};
    while (jump.to - jump.from > resolution * (t - from)) {
      const Real middle = jump.from + (jump.to - jump.from) / 2;
      remember(begin);
      (slip_jumps_by(middle) ? jump.to : jump.from) = middle;
    }
    remember(begin);
    jump.before = jump.from > from ? step(jump.from) : state(from, laws::ContactState::stick);
    for (Real gap = jump.to - jump.from;; gap *= 4) {  // for very short steps rounding may still give a nearby state
      Real old[dim - 1];
      std::copy_n(p_old_, dim - 1, old);
      jump.after = step(jump.to);
      jump.size = distance(old, p_old_);
      if ((jump.after.slip_jumps && jump.size > least) || jump.to == t) break;
      jump.before = jump.after;
      jump.from = jump.to;
      jump.to = std::min(t, jump.to + gap);
    }
    jump.after.remark = jump_in_words(jump);
    return jump;
  }
  /// Computes the state at t from the state at `from`. If there is none, bisection finds the last time with a state.
  /// Throws an Error with this time.
  PointState step_or_last(Real from, Real t) {
    const Memory begin = memory();
    try {
      return step(t);
    } catch (const Error& error) {
      Real last = from, none = t;
      while (none - last > resolution * (t - from)) {
        const Real middle = last + (none - last) / 2;
        remember(begin);
        (has_state(middle) ? last : none) = middle;
      }
      if (last == from) throw;
      throw Error(fmt::format("{}; the last state is that at t = {:.9g}", error.what(), last));
    }
  }
  bool has_state(Real t) {
    try {
      return step(t), true;
    } catch (const Error&) {
      return false;
    }
  }
  bool slip_jumps_by(Real t) {
    try {
      return step(t).slip_jumps;
    } catch (const Error&) {
      return true;
    }
  }
  static Real distance(const Real (&a)[dim - 1], const Real (&b)[dim - 1]) {
    Real difference[dim - 1];
    for (int i = 0; i < dim - 1; ++i) difference[i] = a[i] - b[i];
    return laws::norm(difference);
  }

  static std::string jump_in_words(const Jump& jump) {
    const auto shear = [](const PointState& at) {
      Real tangential[dim - 1];
      std::copy_n(at.traction.begin() + 1, dim - 1, tangential);
      return laws::norm(tangential);
    };
    return fmt::format(
        "slip jumps by {:.4g} m, the shear traction from {:.4g} to {:.4g} Pa: friction decreases faster with slip than "
        "the loading system unloads; both states satisfy the law, states in between do not",
        jump.size, shear(jump.before), shear(jump.after));
  }

  /// Computes the state at t from the last state. Throws an Error if no start of the iteration succeeds.
  PointState step(Real t) {
    for (int i = 0; i < dim; ++i) d_[i] = point_.path[i]({0, 0, 0}, t);
    Real old[2 * dim];
    std::copy_n(x_, 2 * dim, old);
    std::string reason;
    for (Start start :
         {Start{.elastic = true}, {}, {.released = true}, {.damped = true, .released = true}, {.beyond = true}}) {
      for (Real factor : {of_controls, 1.0, 1e2, 1e-2, 1e4, 1e6}) {
        for (int i = 0; i < 2 * dim; ++i)
          x_[i] = !start.released ? old[i] : i < dim && control(i) != "traction" ? rest_[i] + d_[i] : 0;
        if (start.elastic && !stretch()) break;
        if (start.beyond && beyond_.empty()) break;
        if (start.beyond) std::copy_n(beyond_.begin(), 2 * dim, x_);
        const std::string failure = solve(factor, start.damped);
        if (failure.empty()) return accept(t);
        if (reason.empty()) reason = failure;
      }
    }
    std::string prescribed;
    for (int i = 0; i < dim; ++i)
      prescribed += fmt::format("{}{} {} = {:.9g}", i ? ", " : "", control(i), axis(dim, i), d_[i]);
    const std::string beyond = beyond_strength();
    throw Error(fmt::format("t = {}: no state found for {}: {}", t, prescribed, beyond.empty() ? reason : beyond));
  }

  /// Sets the initial traction and the corresponding jump. Throws an Error for tension, or for shear above the bound.
  void press() {
    auto at = laws::contact<dim>(point_.initial_traction[0], laws::norm(p_old_), p_old_, p_old_, {kept_.data()});
    SPREKK_CHECK(at.lambda_n <= 0, "the initial traction is {} along the normal; it must be compressive or 0",
                 at.lambda_n);
    std::copy_n(point_.initial_traction.begin(), dim, base_);
    Real shear[dim - 1];
    std::copy_n(base_ + 1, dim - 1, shear);
    at.shear = laws::norm(shear);
    SPREKK_CHECK(at.shear <= law_.bound(at), "the initial shear traction is {}; the strength of the joint is {}",
                 at.shear, law_.bound(at));
    rest_[0] = law_.normal_gap(at);
    for (int i = 1; i < dim; ++i) rest_[i] = p_old_[i - 1] + law_.compliance(at) * base_[i];
    std::copy_n(rest_, dim, x_);
    std::copy_n(base_, dim, x_ + dim);
  }

  /// Start of Newton's method: last state, elastically stretched state, state without traction, or state beyond a slip
  /// jump; steps with or without damping. The start and the factor on the typical stiffness steer the iteration. If
  /// there are several solutions, they determine the one that is found.
  struct Start {
    bool damped = false, released = false, elastic = false, beyond = false;
  };

  /// Sets x as if the prescribed values deform a bonded joint elastically, so intact states are tried before broken
  /// ones. Returns false if the joint has no bond or no elastic compliance.
  bool stretch() {
    bool stretched = false;
    for (int i = 0; i < dim && law_.is_bonded(); ++i) {
      const Real compliance = i == 0 ? law_.gap.closure.initial_compliance() : law_.elastic.initial_compliance();
      if (compliance == 0) continue;
      if (control(i) == "jump") x_[dim + i] += (rest_[i] + d_[i] - x_[i]) / compliance;
      if (control(i) == "traction") x_[i] += (d_[i] - x_[dim + i]) * compliance;
      stretched = true;
    }
    return stretched;
  }

  const std::string& control(int i) const { return point_.control[i]; }

  /// Stiffness of the column, otherwise of the joint, otherwise the ratio of prescribed values; Pa/m.
  Real typical_stiffness() const {
    Real k = 0, length = 0, stress = 0;
    for (int i = 0; i < dim; ++i) {
      if (control(i) == "column") k = std::max(k, stiffness_[i]);
      Real& size = control(i) == "traction" ? stress : length;
      size = std::max(size, std::abs(d_[i]));
    }
    for (const Real compliance : {law_.elastic.initial_compliance(), law_.gap.closure.initial_compliance()})
      if (k == 0 && compliance > 0) k = 1 / compliance;
    if (k == 0 && length > 0) k = stress / length;
    return k == 0 ? 1 : k;
  }

  /// Scales of jump, m, and traction, Pa, at x, for relative changes; c is a typical stiffness, Pa/m.
  void scales(Real c, Real (&scale)[2 * dim]) const {
    Real length = 1e-300;
    for (int i = 0; i < dim; ++i)
      length = std::max({length, std::abs(x_[i]), std::abs(x_[dim + i]) / c,
                         control(i) == "traction" ? std::abs(d_[i]) / c : std::abs(d_[i])});
    for (int i = 0; i < dim; ++i) {
      scale[i] = length;
      scale[dim + i] = std::max((i == 0 ? c_.normal : c_.tangential) * length, std::abs(x_[dim + i]));
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
    const auto bond = law_.cohesion(at_rest());
    Real length = 1e-300, moved = 0, stress = std::max(bond.shear, bond.strength);
    bool slides = true, column = true;
    for (int i = 0; i < dim; ++i) {
      length = std::max({length, std::abs(x_[i]), std::abs(d_[i]) * (control(i) == "traction" ? 0 : 1)});
      stress = std::max(stress, std::abs(x_[dim + i]));
      if (i == 0) continue;
      moved = std::hypot(moved, x_[i] - p_old_[i - 1]);
      slides = slides && control(i) == "jump";
      column = column && control(i) == "column";
    }
    Real c_t = column ? stiffness_[1] : c;
    if (slides && moved > 0) c_t = far * std::max(c, stress / moved);
    Real c_n = control(0) == "column" ? stiffness_[0] : c;
    if (control(0) == "jump") c_n = std::max(c, far * bond.strength / length);
    if (control(0) == "traction" && d_[0] < 0) c_n = std::min(c, -d_[0] / (far * length));
    return {laws::augmentation(law_, c_n).normal, laws::augmentation(law_, c_t).tangential};
  }

  /// Solves for the state at the prescribed values; returns the reason of a failure, or an empty text. The projection
  /// constants use the typical stiffness times the factor, or the controls. A damped step is halved until the residual
  /// decreases.
  std::string solve(Real factor, bool damped) {
    const Real c = typical_stiffness();
    for (int i = 0; i < dim; ++i) {
      if (control(i) == "jump") x_[i] = rest_[i] + d_[i];
      if (control(i) == "traction") x_[dim + i] = d_[i];
    }
    c_ = factor == of_controls ? augmentation_of_controls(c) : laws::augmentation(law_, c * factor);
    Real f[2 * dim], J[4 * dim * dim], scale[2 * dim];
    for (int iteration = 0; iteration < 50; ++iteration) {
      const auto state = evaluate(f, J);
      scales(c, scale);
      const Real size = size_of(f, scale);
      int info = 0, pivots[2 * dim];
      Teuchos::LAPACK<int, Real>().GESV(2 * dim, 1, J, 2 * dim, pivots, f, 2 * dim, &info);
      Real change = 0, x[2 * dim], step[2 * dim];
      std::copy_n(x_, 2 * dim, x);
      std::copy_n(f, 2 * dim, step);
      for (int i = 0; i < 2 * dim; ++i) {
        if (info != 0 || !(std::abs(step[i]) < 1e10 * scale[i])) return undetermined(state);
        change = std::max(change, std::abs(step[i]) / scale[i]);
      }
      for (Real length = 1; length > 0.01; length /= 2) {
        for (int i = 0; i < 2 * dim; ++i) x_[i] = x[i] - length * step[i];
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
    const bool pulled = std::count(point_.control.begin() + 1, point_.control.end(), "traction") > 0;
    const bool pressed = control(0) == "traction" && d_[0] < 0;
    if (state == laws::ContactState::open && !pressed) return "an open joint has no traction, its jump is unbounded";
    if (state == laws::ContactState::slip && pulled)
      return "the shear traction exceeds the friction bound, the joint slides without bound";
    if (control(0) == "jump" && law_.gap.closure.initial_compliance() == 0)
      return "the faces touch and do not close, the normal jump does not determine the normal traction";
    return not_converged;
  }

  /// Returns true if the prescribed jump of a rigid joint equals that of the last step. Any traction below the friction
  /// bound is then admissible, and the joint retains its last traction.
  bool rests(int i) const {
    if (i == 0 || control(i) != "jump" || law_.elastic.initial_compliance() > 0) return false;
    const Real jump = rest_[i] + d_[i], last = p_old_[i - 1];
    return std::abs(jump - last) <= 1e-14 * std::max(std::abs(jump), std::abs(last));
  }

  /// Computes f and its column-major Jacobian J at x.
  laws::ContactState evaluate(Real (&f)[2 * dim], Real (&J)[4 * dim * dim]) const {
    using Fad = Sacado::Fad::SFad<Real, 2 * dim>;
    ++evaluations_;
    Fad w[dim], lambda[dim], R[dim];
    for (int i = 0; i < dim; ++i) {
      w[i] = Fad(2 * dim, i, x_[i]);
      lambda[i] = Fad(2 * dim, dim + i, x_[dim + i]);
    }
    const auto state = laws::contact_residual<dim>(law_, c_, w, lambda, p_old_, R, {kept_.data()});
    for (int i = 0; i < dim; ++i) {
      if (state == laws::ContactState::stick && rests(i)) R[i] = lambda[i] - x_[dim + i];
      const Fad moved = w[i] - rest_[i];
      const Fad controlled = control(i) == "jump"       ? Fad(moved - d_[i])
                             : control(i) == "traction" ? Fad(lambda[i] - d_[i])
                                                        : Fad(lambda[i] - base_[i] - stiffness_[i] * (d_[i] - moved));
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
    std::copy_n(x_, dim, w);
    std::copy_n(x_ + dim, dim, lambda);
    laws::split_jump<dim>(law_, contact, w, lambda, p_old_, elastic, plastic, {kept_.data()});
    if (contact == laws::ContactState::stick) {
      for (int i = 1; i < dim; ++i) plastic[i] = p_old_[i - 1];
    }
    Real now[dim - 1];
    std::copy_n(plastic + 1, dim - 1, now);
    const auto at = laws::converged<dim>(law_, contact, w, lambda, now, p_old_, {kept_.data()});
    const bool jumps = contact == laws::ContactState::slip && runs_away(at);
    law_.commit(at, {kept_.data()});
    std::copy_n(now, dim - 1, p_old_);
    auto accepted = state(t, contact);
    accepted.slip_jumps = jumps;
    return accepted;
  }

  /// State with the present jump and traction, and the plastic jump of the last step.
  PointState state(Real t, laws::ContactState contact) const {
    Real w[dim], lambda[dim], elastic[dim], plastic[dim];
    std::copy_n(x_, dim, w);
    std::copy_n(x_ + dim, dim, lambda);
    laws::split_jump<dim>(law_, contact, w, lambda, p_old_, elastic, plastic, {kept_.data()});
    std::copy_n(p_old_, dim - 1, plastic + 1);
    return {t,
            contact,
            {w, w + dim},
            {elastic, elastic + dim},
            {plastic, plastic + dim},
            {lambda, lambda + dim},
            strength(lambda[0])};
  }

  /// Bound of |lambda_t| at a normal traction after the slip so far, Pa.
  Real strength(Real lambda_n) const {
    auto at = at_rest();
    at.lambda_n = std::min(lambda_n, Real(0));
    return std::max(law_.bound(at), Real(0));
  }

  /// Contact with the accumulated slip and no slip in the step.
  laws::Contact<Real> at_rest() const {
    laws::Contact<Real> at;
    at.dim = dim;
    at.history = {kept_.data()};
    at.plastic_slip = laws::norm(p_old_);
    for (int i = 0; i < dim - 1; ++i) at.plastic_jump[i] = at.last_plastic_jump[i] = p_old_[i];
    return at;
  }

  /// Returns true if friction decreases faster than column and joint unload, anywhere along the slip of the step. Then
  /// no continuous path of states connects its begin and end.
  bool runs_away(const laws::Contact<Real>& end) const {
    const Real compliance = law_.compliance(end) + (control(1) == "column" ? 1 / stiffness_[1] : 0);
    for (int k = 0; k <= samples; ++k) {
      auto at = end;
      const Real part = Real(k) / samples;
      at.slip_of_step = part * end.slip_of_step;
      for (int i = 0; i < dim - 1; ++i) at.plastic_jump[i] = p_old_[i] + part * (end.plastic_jump[i] - p_old_[i]);
      at.plastic_slip = std::hypot(at.plastic_jump[0], at.plastic_jump[1]);
      if (physics::weakening(law_, at) * compliance > 1) return true;
    }
    return false;
  }

  /// Message if the prescribed tension exceeds the tensile strength; otherwise empty.
  std::string beyond_strength() const {
    if (control(0) != "traction" || !law_.is_bonded()) return "";
    const Real strength = law_.cohesion(at_rest()).strength;
    if (!(strength > 0) || !(d_[0] > strength)) return "";
    return fmt::format("the tension of {:.6g} Pa exceeds the tensile strength, {:.6g} Pa now", d_[0], strength);
  }

  mutable long evaluations_ = 0;
  std::vector<Real> beyond_;  // x of a state beyond a slip jump to be found
  const PointPath& point_;
  laws::Joint law_;
  laws::Augmentation c_;
  std::vector<Real> kept_ = std::vector<Real>(law_.n_history(), 0);  // history variables of the law at the point
  Real stiffness_[dim], d_[dim], x_[2 * dim] = {}, p_old_[dim - 1] = {};
  Real base_[dim] = {}, rest_[dim] = {};  // initial traction and its jump
};

}  // namespace sprekk::laboratory
