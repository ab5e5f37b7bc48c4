#include "model/point.hpp"

#include "base/check.hpp"
#include "base/text.hpp"
#include "base/xml.hpp"
#include "physics/material_library.hpp"
#include "physics/mechanics/joint_material.hpp"

#include <Sacado.hpp>
#include <Teuchos_LAPACK.hpp>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace sprekk::model {

namespace {

constexpr const char* axes[] = {"n", "t1", "t2"};

/// "n", then "t" in 2D, "t1" and "t2" in 3D.
const char* axis(std::size_t dim, std::size_t i) { return dim == 2 && i == 1 ? "t" : axes[i]; }

/// Newton's method on R(w, lambda) = 0 and one control equation per component; unknowns w, lambda.
template <int dim>
class PointDriver {
 public:
  explicit PointDriver(const PointScene& scene)
      : point_(scene.point), law_(scene.materials.at(scene.point.material).joint({0, 0, 0}).law) {
    for (std::size_t i = 0; i < point_.plastic_jump.size(); ++i) p_old_[i] = point_.plastic_jump[i];
    for (int i = 0; i < dim; ++i) stiffness_[i] = i == 0 ? point_.normal_stiffness : point_.tangential_stiffness;
    law_.sliding_compliance = 0;  // it steers the iteration on meshes
    if (!point_.initial_traction.empty()) press();
  }

  PointState step(Real t) {
    for (int i = 0; i < dim; ++i) d_[i] = point_.path[i]({0, 0, 0}, t);
    Real old[2 * dim];
    std::copy_n(x_, 2 * dim, old);
    std::string reason;
    for (Start start : {Start{.elastic = true}, {}, {.released = true}, {.damped = true, .released = true}}) {
      for (Real factor : {1.0, 1e2, 1e-2, 1e4, 1e6}) {
        for (int i = 0; i < 2 * dim; ++i)
          x_[i] = !start.released ? old[i] : i < dim && control(i) != "traction" ? rest_[i] + d_[i] : 0;
        if (start.elastic && !stretch()) break;
        const std::string failure = solve(factor, start.damped);
        if (failure.empty()) return accept(t);
        if (reason.empty()) reason = failure;
      }
    }
    std::string prescribed;
    for (int i = 0; i < dim; ++i)
      prescribed += fmt::format("{}{} {} = {}", i ? ", " : "", control(i), axis(dim, i), d_[i]);
    throw Error(fmt::format("point: t = {}: no state found for {}: {}", t, prescribed, reason));
  }

 private:
  /// Starts from the initial traction, and the jump that the joint has under it.
  void press() {
    auto at = laws::contact<dim>(point_.initial_traction[0], laws::norm(p_old_), p_old_, p_old_, {kept_.data()});
    SPREKK_CHECK(at.lambda_n <= 0, "point: the initial traction is {} along the normal; it must press, or be 0",
                 at.lambda_n);
    std::copy_n(point_.initial_traction.begin(), dim, base_);
    Real shear[dim - 1];
    std::copy_n(base_ + 1, dim - 1, shear);
    at.shear = laws::norm(shear);
    SPREKK_CHECK(at.shear <= law_.bound(at), "point: the initial traction shears by {}; the joint bears {}", at.shear,
                 law_.bound(at));
    rest_[0] = law_.normal_gap(at);
    for (int i = 1; i < dim; ++i) rest_[i] = p_old_[i - 1] + law_.compliance(at) * base_[i];
    std::copy_n(rest_, dim, x_);
    std::copy_n(base_, dim, x_ + dim);
  }

  /// Where Newton's method starts, the last state, that stretched, or one without traction, and whether its steps are
  /// damped. These and the factor on the typical stiffness steer the iteration; which solution is found, if there are
  /// several, depends on them.
  struct Start {
    bool damped = false, released = false, elastic = false;
  };

  /// Moves x to where what is prescribed only stretches a joint with a bond: a state that is whole comes before one that
  /// is broken. False where there is none such to be expected.
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

  /// The stiffness of the column, else of the joint, else what the prescribed values suggest.
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

  /// Sizes of jump and traction at x, which changes are judged by; c is a typical stiffness.
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

  /// Moves x to the state at the prescribed values; returns why there is none, or nothing. The constants of the
  /// projection are those of the typical stiffness times the factor; a damped step is halved until the residual falls.
  std::string solve(Real factor, bool damped) {
    const Real c = typical_stiffness();
    c_ = laws::augmentation(law_, c * factor);
    for (int i = 0; i < dim; ++i) {
      if (control(i) == "jump") x_[i] = rest_[i] + d_[i];
      if (control(i) == "traction") x_[dim + i] = d_[i];
    }
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
    return "Newton's method does not converge";
  }

  /// The residual, each of its entries in its unit over that unit's size.
  Real size_of(const Real (&f)[2 * dim], const Real (&scale)[2 * dim]) const {
    Real square = 0;
    for (int i = 0; i < dim; ++i) {
      const Real control_scale = control(i) == "jump" ? scale[i] : scale[dim + i];
      square += std::pow(f[i] / scale[dim + i], 2) + std::pow(f[dim + i] / control_scale, 2);
    }
    return std::sqrt(square);
  }

  /// Why the equations of a contact state do not determine jump and traction.
  std::string undetermined(laws::ContactState state) const {
    const bool pulled = std::count(point_.control.begin() + 1, point_.control.end(), "traction") > 0;
    if (state == laws::ContactState::open) return "an open joint bears no traction, its jump has no bound";
    if (state == laws::ContactState::slip && pulled)
      return "the shear traction exceeds the friction bound, the joint slides without bound";
    if (control(0) == "jump" && law_.gap.closure.initial_compliance() == 0)
      return "the faces touch and do not close, the normal jump does not determine the normal traction";
    if (state == laws::ContactState::stick && law_.elastic.initial_compliance() == 0)
      return "a rigid joint sticks, the jump does not determine the shear traction";
    return "the prescribed values do not determine jump and traction";
  }

  /// f and its column-major Jacobian J at x.
  laws::ContactState evaluate(Real (&f)[2 * dim], Real (&J)[4 * dim * dim]) const {
    using Fad = Sacado::Fad::SFad<Real, 2 * dim>;
    Fad w[dim], lambda[dim], R[dim];
    for (int i = 0; i < dim; ++i) {
      w[i] = Fad(2 * dim, i, x_[i]);
      lambda[i] = Fad(2 * dim, dim + i, x_[dim + i]);
    }
    const auto state = laws::contact_residual<dim>(law_, c_, w, lambda, p_old_, R, {kept_.data()});
    for (int i = 0; i < dim; ++i) {
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
    const auto state = evaluate(f, J);
    Real w[dim], lambda[dim], elastic[dim], plastic[dim];
    std::copy_n(x_, dim, w);
    std::copy_n(x_ + dim, dim, lambda);
    laws::split_jump<dim>(law_, state, w, lambda, p_old_, elastic, plastic, {kept_.data()});
    if (state == laws::ContactState::stick) {
      for (int i = 1; i < dim; ++i) plastic[i] = p_old_[i - 1];
    }
    Real now[dim - 1];
    std::copy_n(plastic + 1, dim - 1, now);
    const auto at = laws::converged<dim>(law_, state, w, lambda, now, p_old_, {kept_.data()});
    const std::string remark = state == laws::ContactState::slip ? runaway(at) : "";
    law_.commit(at, {kept_.data()});
    std::copy_n(now, dim - 1, p_old_);
    laws::split_jump<dim>(law_, state, w, lambda, p_old_, elastic, plastic, {kept_.data()});
    std::copy_n(now, dim - 1, plastic + 1);
    return {t, state, {w, w + dim}, {elastic, elastic + dim}, {plastic, plastic + dim}, {lambda, lambda + dim}, remark};
  }

  /// Says so if slip weakens the joint faster than column and joint unload, where the slip of the step begins.
  std::string runaway(const laws::Contact<Real>& end) const {
    auto begin = end;
    begin.slip_of_step = 0;
    begin.plastic_slip = laws::norm(p_old_);
    std::copy_n(p_old_, dim - 1, begin.plastic_jump);
    const Real falls = physics::weakening(law_, begin);
    const Real compliance = law_.compliance(end) + (control(1) == "column" ? 1 / stiffness_[1] : 0);
    if (!(falls * compliance > 1)) return "";
    return fmt::format(
        "slip of {:.4g} at once: its bound falls by {:.4g} Pa/m at first, and what shears the joint unloads by "
        "{:.4g} Pa/m; this state obeys the law, others between may do so",
        end.slip_of_step, falls, 1 / compliance);
  }

  const PointPath& point_;
  laws::Joint law_;
  laws::Augmentation c_;
  std::vector<Real> kept_ = std::vector<Real>(law_.n_history(), 0);  // what the laws keep of the point
  Real stiffness_[dim], d_[dim], x_[2 * dim] = {}, p_old_[dim - 1] = {};
  Real base_[dim] = {}, rest_[dim] = {};  // the initial traction, and the jump under it
};

template <int dim>
std::vector<PointState> drive(const PointScene& scene) {
  PointDriver<dim> driver(scene);
  std::vector<PointState> states;
  for (Real t : scene.time.times()) states.push_back(driver.step(t));
  return states;
}

}  // namespace

void PointPath::describe(base::Section& s) {
  s.required(material, "material", "-", "name of a joint material, of this scene or of the library");
  s.required(control, "control", "-", "per component n, t[, t2] what is prescribed: jump, traction, or column");
  std::string units;  // of the components
  for (const auto& what : control) units += (units.empty() ? "" : ", ") + std::string(what == "traction" ? "Pa" : "m");
  s.required(
      path, "path", units.empty() ? "m or Pa" : units,
      "per component the jump, the traction, or the displacement of the column's end: values or expressions of t");
  s.entry(normal_stiffness, "column normal stiffness", "Pa/m", base::at_least(0),
          "k of a column in lambda_n = k (d_n - w_n)");
  s.entry(tangential_stiffness, "column tangential stiffness", "Pa/m", base::at_least(0),
          "k of a column in lambda_t = k (d_t - w_t)");
  s.entry(plastic_jump, "plastic jump", "m", base::any(),
          "tangential plastic jump at the start, per tangential component");
  s.entry(initial_traction, "initial traction", "Pa", base::any(),
          "per component n, t[, t2], at the start: jumps and displacements then count from the jump under it");
  if (!s.complete()) return;
  if (control.size() < 2 || control.size() > 3) s.fail("control", "needs 2 components (2D) or 3 (3D)");
  if (path.size() != control.size())
    s.fail("path", fmt::format("has {} components, \"control\" has {}", path.size(), control.size()));
  if (!plastic_jump.empty() && plastic_jump.size() + 1 != control.size())
    s.fail("plastic jump", fmt::format("has {} components, must have {}", plastic_jump.size(), control.size() - 1));
  if (!initial_traction.empty() && initial_traction.size() != control.size())
    s.fail("initial traction", fmt::format("has {} components, must have {}", initial_traction.size(), control.size()));
  for (std::size_t i = 0; i < control.size(); ++i) {
    if (control[i] != "jump" && control[i] != "traction" && control[i] != "column")
      s.fail("control", fmt::format("is \"{}\" for component {}, must be jump, traction or column", control[i], i));
    const Real k = i == 0 ? normal_stiffness : tangential_stiffness;
    if (control[i] == "column" && !(k > 0))
      s.fail(i == 0 ? "column normal stiffness" : "column tangential stiffness", "missing; a column needs it, above 0");
  }
}

void PointScene::describe(base::Section& s) {
  s.named_sections(tables, "Tables", "piecewise linear functions that expressions call by name");
  s.named_expressions(expressions, "Expressions", "what all other expressions may call by name");
  s.expressions_call(tables, expressions);
  s.named_sections(materials, "Materials", "joints, by names of your choice");
  s.section(time, "Time", "steps");
  s.section(point, "Point", "what drives the point");
  if (!s.complete()) return;
  physics::add_library_materials(materials, {point.material});
  const std::string wrong = physics::wrong_material(point.material, "joint", materials);
  if (!wrong.empty()) s.fail_inside("Point > \"material\": " + wrong);
  if (!wrong.empty() || point.control.size() != 3) return;
  for (const auto& [entry, what] : materials.at(point.material).only_in_2d())
    s.fail_inside(fmt::format("Materials > {} > \"{}\": {}", point.material, entry, what));
}

PointScene read_point_scene(const Comm& comm, const std::string& path, const std::vector<std::string>& overrides) {
  auto list = base::read_xml(comm, path, "Sprekk", base::Defects::keep);
  SPREKK_CHECK(list.isParameter("Point") || !list.isParameter("Bulk"),
               "{}: is a scene for `sprekk run`: it has the section \"Bulk\" and no \"Point\"", path);
  const auto errors = base::apply_overrides(list, path, overrides);
  return base::read<PointScene>(list, path, "Sprekk", errors);
}

std::vector<PointState> drive_point(const PointScene& scene) {
  return scene.point.control.size() == 2 ? drive<2>(scene) : drive<3>(scene);
}

void write_csv(std::ostream& out, const std::vector<PointState>& states) {
  out << "t,state";
  const std::size_t dim = states.empty() ? 0 : states.front().jump.size();
  for (const char* name : {"jump", "elastic_jump", "plastic_jump", "traction"})
    for (std::size_t i = 0; i < dim; ++i) out << ',' << name << '_' << axis(dim, i);
  out << '\n';
  for (const auto& s : states) {
    out << fmt::format("{:.17g},{}", s.t, static_cast<int>(s.contact));
    for (const auto* values : {&s.jump, &s.elastic, &s.plastic, &s.traction})
      for (Real value : *values) out << fmt::format(",{:.17g}", value);
    out << '\n';
  }
}

}  // namespace sprekk::model
