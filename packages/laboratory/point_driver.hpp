// Steps of one point of a joint along a path.
#pragma once

#include "base/check.hpp"
#include "laboratory/joint_point.hpp"
#include "laws/joint_parameters.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace sprekk::laboratory {

/// Path of one point. Each step starts Newton's method from several states, and searches slip jumps.
template <int dim>
class PointDriver {
 public:
  using Joint = JointPoint<dim>;

  PointDriver(const PointPath& path, const physics::Material& material) : joint_(path, path.joint_of(material)) {}

  /// State before the first step: without traction, or under the initial traction.
  PointState initial(Real t) {
    Real f[2 * dim], J[4 * dim * dim];
    joint_.time = t;
    joint_.constants = laws::augmentation(joint_.law, joint_.typical_stiffness());
    return joint_.state(t, joint_.evaluate(f, J));
  }

  /// Advances from the last time `from` to t, s. Returns one state, or also those before and after each slip jump.
  /// Throws an Error if no state is found.
  std::vector<PointState> advance(Real from, Real t) {
    std::vector<PointState> states;
    for (int jumps = 0; jumps < max_jumps; ++jumps) {
      const typename Joint::Memory begin = joint_.memory();
      const auto next = step_or_last(from, t);
      const typename Joint::Memory end = joint_.memory();
      const Real minimum = min_jump * Joint::distance(begin.plastic, end.plastic);
      beyond_ = next.slip_jumps ? std::vector<Real>(end.x, end.x + 2 * dim) : std::vector<Real>();
      const auto jump = next.slip_jumps ? jump_of_slip(begin, from, t, minimum) : Jump{};
      beyond_.clear();
      if (!(jump.size > minimum)) {
        joint_.remember(end);
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

  /// Data changed by steps.
  typename Joint::Memory memory() const { return joint_.memory(); }
  void remember(const typename Joint::Memory& memory) { joint_.remember(memory); }

  /// Returns true if the tension prescribed at t exceeds the present strength: there is no state, the joint separates.
  bool is_pulled(Real t) const { return joint_.is_pulled(t); }
  /// Sets a fully open joint without traction. The prescribed tangential jumps at t apply.
  void part(Real t) { joint_.part(t); }

  /// Names of PointState::quantities.
  const std::vector<std::string>& quantities() const { return joint_.names; }

  /// Number of law evaluations with derivatives, one per residual evaluation.
  long evaluations() const { return joint_.evaluations; }

 private:
  static constexpr int max_jumps = 8;       // slip jumps per step
  static constexpr Real resolution = 1e-9;  // of the time of a slip jump, relative to the step
  static constexpr Real min_jump = 1e-6;    // relative to the slip of the step

  /// Slip jump between two adjacent times.
  struct Jump {
    Real from = 0, to = 0, size = 0;
    PointState before = {}, after = {};
  };

  /// Finds the first jump larger than `minimum` between the state `begin` at the time `from` and t. Afterwards the
  /// driver is at the state after the jump. The time is found by bisection; there is no slip jump before it.
  Jump jump_of_slip(const typename Joint::Memory& begin, Real from, Real t, Real minimum) {
    Jump jump{from, t};
    while (jump.to - jump.from > resolution * (t - from)) {
      const Real middle = jump.from + (jump.to - jump.from) / 2;
      joint_.remember(begin);
      (slip_jumps_by(middle) ? jump.to : jump.from) = middle;
    }
    joint_.remember(begin);
    jump.before = jump.from > from ? step(jump.from) : joint_.state(from, laws::ContactState::stick);
    for (Real gap = jump.to - jump.from;; gap *= 4) {  // for very short steps rounding may still give a nearby state
      Real old[dim - 1];
      std::copy_n(joint_.last_plastic, dim - 1, old);
      jump.after = step(jump.to);
      jump.size = Joint::distance(old, joint_.last_plastic);
      if ((jump.after.slip_jumps && jump.size > minimum) || jump.to == t) break;
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
    const typename Joint::Memory begin = joint_.memory();
    try {
      return step(t);
    } catch (const Error& error) {
      Real last = from, none = t;
      while (none - last > resolution * (t - from)) {
        const Real middle = last + (none - last) / 2;
        if (middle <= last || middle >= none) break;  // neighbouring numbers
        joint_.remember(begin);
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
    for (int i = 0; i < dim; ++i) joint_.prescribed[i] = joint_.path.path[i]({0, 0, 0}, t);
    joint_.duration = t - joint_.time;
    Real old[2 * dim];
    std::copy_n(joint_.unknowns, 2 * dim, old);
    std::string reason;
    for (Start start :
         {Start{.elastic = true}, {}, {.released = true}, {.damped = true, .released = true}, {.beyond = true}}) {
      for (Real factor : {Joint::of_controls, 1.0, 1e2, 1e-2, 1e4, 1e6}) {
        for (int i = 0; i < 2 * dim; ++i)
          joint_.unknowns[i] = !start.released                              ? old[i]
                               : i < dim && joint_.control(i) != "traction" ? joint_.rest[i] + joint_.prescribed[i]
                                                                            : 0;
        if (start.elastic && !joint_.stretch()) break;
        if (start.beyond && beyond_.empty()) break;
        if (start.beyond) std::copy_n(beyond_.begin(), 2 * dim, joint_.unknowns);
        const std::string failure = joint_.solve(factor, start.damped);
        if (failure.empty()) return joint_.accept(t);
        if (reason.empty()) reason = failure;
      }
    }
    std::string prescribed;
    for (int i = 0; i < dim; ++i)
      prescribed +=
          fmt::format("{}{} {} = {:.9g}", i ? ", " : "", joint_.control(i), axis(dim, i), joint_.prescribed[i]);
    const std::string beyond = joint_.beyond_strength();
    throw Error(fmt::format("t = {}: no state found for {}: {}", t, prescribed, beyond.empty() ? reason : beyond));
  }

  /// Start of Newton's method: last state, elastically stretched state, state without traction, or state beyond a slip
  /// jump; steps with or without damping. The start and the factor on the typical stiffness steer the iteration. If
  /// there are several solutions, they determine the one that is found.
  struct Start {
    bool damped = false, released = false, elastic = false, beyond = false;
  };

  JointPoint<dim> joint_;
  std::vector<Real> beyond_;  // x of a state beyond a slip jump to be found
};

}  // namespace sprekk::laboratory
