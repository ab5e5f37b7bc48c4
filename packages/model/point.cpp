#include "model/point.hpp"

#include "base/check.hpp"
#include "base/text.hpp"
#include "base/xml.hpp"

#include <Sacado.hpp>
#include <Teuchos_LAPACK.hpp>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace sprekk::model {

namespace {

/// Newton's method on R(w, lambda) = 0 and one control equation per component; unknowns w, lambda.
template <int dim>
class PointDriver {
 public:
  explicit PointDriver(const PointScene& scene)
      : point_(scene.point), law_(scene.materials.at(scene.point.material).joint({0, 0, 0}).law) {
    for (std::size_t i = 0; i < point_.plastic_jump.size(); ++i) p_old_[i] = point_.plastic_jump[i];
    for (int i = 0; i < dim; ++i) stiffness_[i] = i == 0 ? point_.normal_stiffness : point_.tangential_stiffness;
    c_ = laws::augmentation(law_, typical_stiffness());
  }

  PointState step(Real t) {
    Real d[dim];
    for (int i = 0; i < dim; ++i) d[i] = point_.path[i]({0, 0, 0}, t);
    Real old[2 * dim];
    std::copy_n(x_, 2 * dim, old);
    Real length = 0, stress = 0;  // sizes that the step is judged by
    for (int i = 0; i < dim; ++i) {
      const Real size = std::max(std::abs(d[i]), std::abs(x_[dim + i]));
      (point_.control[i] == "traction" ? stress : length) =
          std::max(point_.control[i] == "traction" ? stress : length, size);
    }
    length = std::max({length, stress / c_.normal, std::abs(x_[0])});
    stress = std::max(stress, length * std::min(c_.normal, c_.tangential));
    for (int iteration = 0; iteration < 50; ++iteration) {
      Real f[2 * dim], J[4 * dim * dim];
      const auto state = evaluate(d, f, J);
      if (size_of(f, length, stress) <= 1e-14) return accept(t, state);
      int info = 0, pivots[2 * dim];
      Teuchos::LAPACK<int, Real>().GESV(2 * dim, 1, J, 2 * dim, pivots, f, 2 * dim, &info);
      Real change = 0;
      for (int i = 0; i < 2 * dim; ++i) {
        SPREKK_CHECK(info == 0 && std::isfinite(f[i]),
                     "point: t = {}: the prescribed jump or traction leaves the state of the joint undetermined", t);
        x_[i] -= f[i];
        change = std::max(change, std::abs(f[i]) / (i < dim ? length : stress));
      }
      if (change <= 1e-15 && iteration > 0) return accept(t, evaluate(d, f, J));
    }
    std::copy_n(old, 2 * dim, x_);
    throw Error(fmt::format("point: t = {}: no state found that obeys the joint law and the prescribed values", t));
  }

 private:
  Real typical_stiffness() const {
    Real k = 0;
    for (int i = 0; i < dim; ++i)
      if (point_.control[i] == "column") k = std::max(k, stiffness_[i]);
    if (k == 0 && law_.elastic.compliance > 0) k = 1 / law_.elastic.compliance;
    if (k == 0 && law_.gap.closure.maximum > 0) k = law_.gap.closure.stiffness;
    return k == 0 ? 1 : k;
  }

  /// f and its column-major Jacobian J at x.
  laws::ContactState evaluate(const Real (&d)[dim], Real (&f)[2 * dim], Real (&J)[4 * dim * dim]) const {
    using Fad = Sacado::Fad::SFad<Real, 2 * dim>;
    Fad w[dim], lambda[dim], R[dim];
    for (int i = 0; i < dim; ++i) {
      w[i] = Fad(2 * dim, i, x_[i]);
      lambda[i] = Fad(2 * dim, dim + i, x_[dim + i]);
    }
    const auto state = laws::contact_residual<dim>(law_, c_, w, lambda, p_old_, R);
    for (int i = 0; i < dim; ++i) {
      const Fad control = point_.control[i] == "jump"       ? Fad(w[i] - d[i])
                          : point_.control[i] == "traction" ? Fad(lambda[i] - d[i])
                                                            : Fad(lambda[i] - stiffness_[i] * (d[i] - w[i]));
      f[i] = R[i].val();
      f[dim + i] = control.val();
      for (int j = 0; j < 2 * dim; ++j) {
        J[j * 2 * dim + i] = R[i].dx(j);
        J[j * 2 * dim + dim + i] = control.dx(j);
      }
    }
    return state;
  }

  /// Largest residual, each in the unit that it has.
  Real size_of(const Real (&f)[2 * dim], Real length, Real stress) const {
    Real size = 0;
    for (int i = 0; i < dim; ++i) {
      size = std::max(size, std::abs(f[i]) / std::max(stress, 1e-300));
      size = std::max(size, std::abs(f[dim + i]) / std::max(point_.control[i] == "jump" ? length : stress, 1e-300));
    }
    return size;
  }

  PointState accept(Real t, laws::ContactState state) {
    Real w[dim], lambda[dim], elastic[dim], plastic[dim];
    std::copy_n(x_, dim, w);
    std::copy_n(x_ + dim, dim, lambda);
    laws::split_jump<dim>(law_, state, w, lambda, elastic, plastic);
    if (state == laws::ContactState::stick) {
      for (int i = 1; i < dim; ++i) plastic[i] = p_old_[i - 1];
    }
    for (int i = 1; i < dim; ++i) p_old_[i - 1] = plastic[i];
    return {t, state, {w, w + dim}, {elastic, elastic + dim}, {plastic, plastic + dim}, {lambda, lambda + dim}};
  }

  const PointPath& point_;
  laws::Joint law_;
  laws::Augmentation c_;
  Real stiffness_[dim], x_[2 * dim] = {}, p_old_[dim - 1] = {};
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
  s.required(material, "material", "-", "name of a joint material");
  s.required(control, "control", "-", "per component n, t[, t2] what is prescribed: jump, traction, or column");
  s.required(
      path, "path", "m or Pa",
      "per component the jump, the traction, or the displacement of the column's end: values or expressions of t");
  s.entry(normal_stiffness, "column normal stiffness", "Pa/m", base::at_least(0),
          "k of a column in lambda_n = k (d_n - w_n)");
  s.entry(tangential_stiffness, "column tangential stiffness", "Pa/m", base::at_least(0),
          "k of a column in lambda_t = k (d_t - w_t)");
  s.entry(plastic_jump, "plastic jump", "m", base::any(),
          "tangential plastic jump at the start, per tangential component");
  if (!s.complete()) return;
  if (control.size() < 2 || control.size() > 3) s.fail("control", "needs 2 components (2D) or 3 (3D)");
  if (path.size() != control.size())
    s.fail("path", fmt::format("has {} components, \"control\" has {}", path.size(), control.size()));
  if (!plastic_jump.empty() && plastic_jump.size() + 1 != control.size())
    s.fail("plastic jump", fmt::format("has {} components, must have {}", plastic_jump.size(), control.size() - 1));
  for (std::size_t i = 0; i < control.size(); ++i) {
    if (control[i] != "jump" && control[i] != "traction" && control[i] != "column")
      s.fail("control", fmt::format("is \"{}\" for component {}, must be jump, traction or column", control[i], i));
    const Real k = i == 0 ? normal_stiffness : tangential_stiffness;
    if (control[i] == "column" && !(k > 0))
      s.fail(i == 0 ? "column normal stiffness" : "column tangential stiffness", "missing; a column needs it, above 0");
  }
}

void PointScene::describe(base::Section& s) {
  s.named_sections(materials, "Materials", "joints, by names of your choice");
  s.named_sections(tables, "Tables", "piecewise linear functions that expressions call by name");
  s.section(time, "Time", "steps");
  s.section(point, "Point", "what drives the point");
  if (!s.complete()) return;
  const auto found = materials.find(point.material);
  if (found == materials.end() || found->second.type != "joint")
    s.fail_inside(fmt::format("Point > \"material\": is \"{}\", must be the name of a joint material", point.material));
}

PointScene read_point_scene(const Comm& comm, const std::string& path, const std::vector<std::string>& overrides) {
  auto list = base::read_xml(comm, path, "Sprekk");
  for (const auto& text : overrides) base::apply_override(list, text);
  auto scene = base::read<PointScene>(list, path, "Sprekk");
  const auto tables = std::make_shared<const base::Tables>(scene.tables);
  for (auto& [name, material] : scene.materials) material.compile(tables);
  for (auto& expression : scene.point.path) expression.compile(tables);
  return scene;
}

std::vector<PointState> drive_point(const PointScene& scene) {
  return scene.point.control.size() == 2 ? drive<2>(scene) : drive<3>(scene);
}

void write_csv(std::ostream& out, const std::vector<PointState>& states) {
  const char* axes[] = {"n", "t1", "t2"};
  out << "t,state";
  const std::size_t dim = states.empty() ? 0 : states.front().jump.size();
  for (const char* name : {"jump", "elastic_jump", "plastic_jump", "traction"})
    for (std::size_t i = 0; i < dim; ++i) out << ',' << name << '_' << (dim == 2 && i == 1 ? "t" : axes[i]);
  out << '\n';
  for (const auto& s : states) {
    out << fmt::format("{:.17g},{}", s.t, static_cast<int>(s.contact));
    for (const auto* values : {&s.jump, &s.elastic, &s.plastic, &s.traction})
      for (Real value : *values) out << fmt::format(",{:.17g}", value);
    out << '\n';
  }
}

}  // namespace sprekk::model
