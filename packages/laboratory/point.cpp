#include "laboratory/point.hpp"

#include "base/check.hpp"
#include "base/text.hpp"
#include "base/xml.hpp"
#include "laboratory/point_driver.hpp"
#include "physics/material_library.hpp"

#include <algorithm>
#include <ostream>

namespace sprekk::laboratory {

namespace {

fields::StepErrors step_errors(const laws::StepDefect& defect) {
  const Real order = defect.rate < 0 ? fields::StepError::unknown : 3;
  return {{"slip rate", std::max(defect.rate, Real(0)), order},
          {"friction state", std::max(defect.state, Real(0)), order},
          {"growth of instabilities", defect.growth, 3}};
}

/// Appends the states of adaptive steps from the initial state of the driver. A step without state is repeated with a
/// smaller length. Throws an Error if the smallest step has no state.
template <int dim>
void choose_steps(PointDriver<dim>& driver, const solve::Time& time, std::vector<PointState>& states) {
  const auto options = time.control(true, true);
  const auto times = time.times();
  solve::StepControl control(options, times);
  for (Real t = time.start; t < times.back();) {
    const Real end = control.end_of_step(t), dt = end - t;
    const auto begin = driver.memory();
    try {
      const auto state = driver.advance(t, end).back();
      if (control.judge(dt, step_errors(state.defect), 0) != solve::StepControl::Verdict::rejected) {
        states.push_back(state);
        t = end;
        continue;
      }
    } catch (const Error& error) {
      if (options.smallest > 0.9 * dt) throw Error(fmt::format("step from {:.9g} s: {}", t, error.what()));
      control.shorten(dt, 1);
    }
    driver.remember(begin);
  }
}

template <int dim>
PointCurve drive(const PointPath& path, const physics::Material& material, const solve::Time& time) {
  PointCurve curve;
  const auto times = time.times();
  std::string step;
  std::string apart;  // reason why the faces are separated, if they are
  try {
    PointDriver<dim> driver(path, material);
    curve.quantities = driver.quantities();
    curve.initial = driver.initial(time.start);
    if (time.chooses_steps()) {
      choose_steps(driver, time, curve.states);
      return curve;
    }
    Real last = time.start;
    for (std::size_t k = 0; k < times.size(); last = times[k], ++k) {
      step = fmt::format("step {} of {}, ", k + 1, times.size());
      try {
        auto states = driver.advance(last, times[k]);
        if (!apart.empty()) states.front().remark = apart + "; the faces are apart until they are pressed again";
        apart.clear();
        for (auto& state : states) curve.states.push_back(std::move(state));
      } catch (const Error& error) {
        if (!driver.is_pulled(times[k])) throw;
        if (apart.empty()) apart = step + error.what();
        driver.part(times[k]);
      }
    }
    curve.failure = apart;
  } catch (const Error& error) {
    curve.failure = step + error.what();
  }
  return curve;
}

/// Quotes a text as a field of CSV.
std::string in_quotes(const std::string& text) {
  std::string quoted = "\"";
  for (char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

}  // namespace

void PointPath::describe(base::Section& s) {
  s.required(material, "material", "-", "name of a joint material of this scene or of the library");
  s.required(control, "control", "-", "prescribed quantity per component n, t[, t2]: jump, traction, or column");
  std::string units;  // units of the components
  for (const auto& what : control) units += (units.empty() ? "" : ", ") + std::string(what == "traction" ? "Pa" : "m");
  s.required(path, "path", units.empty() ? "m or Pa" : units,
             "values of the prescribed quantity per component, for a column the displacement of its end: values or "
             "expressions of t");
  s.entry(normal_stiffness, "column normal stiffness", "Pa/m", base::at_least(0),
          "normal stiffness k of a column in lambda_n = k (d_n - w_n)");
  s.entry(tangential_stiffness, "column tangential stiffness", "Pa/m", base::at_least(0),
          "tangential stiffness k of a column in lambda_t = k (d_t - w_t)");
  s.entry(plastic_jump, "plastic jump", "m", base::any(), "initial tangential plastic jump, per tangential component");
  s.entry(initial_traction, "initial traction", "Pa", base::any(),
          "initial traction per component n, t[, t2]; jumps and displacements are relative to the jump under this "
          "traction");
  s.entry(
      slip_path, "slip path", "m", base::at_least(0),
      "length of the path of the initial slip, of joints with a \"reference state\" in situ; absent: the size of the "
      "plastic jump");
  if (!s.complete()) return;
  if (control.size() < 2 || control.size() > 3) s.fail("control", "needs 2 components (2D) or 3 (3D)");
  if (path.size() != control.size())
    s.fail("path", fmt::format("number of components is {}, that of \"control\" is {}", path.size(), control.size()));
  if (!plastic_jump.empty() && plastic_jump.size() + 1 != control.size())
    s.fail("plastic jump",
           fmt::format("number of components is {}, must be {}", plastic_jump.size(), control.size() - 1));
  if (!initial_traction.empty() && initial_traction.size() != control.size())
    s.fail("initial traction",
           fmt::format("number of components is {}, must be {}", initial_traction.size(), control.size()));
  for (std::size_t i = 0; i < control.size(); ++i) {
    if (control[i] != "jump" && control[i] != "traction" && control[i] != "column")
      s.fail("control", fmt::format("is \"{}\" for component {}, must be jump, traction or column", control[i], i));
    const Real k = i == 0 ? normal_stiffness : tangential_stiffness;
    if (control[i] == "column" && !(k > 0))
      s.fail(i == 0 ? "column normal stiffness" : "column tangential stiffness", "missing; a column needs it, above 0");
  }
}

std::array<Real, 3> PointPath::start_traction() const {
  std::array<Real, 3> traction{};
  std::copy(initial_traction.begin(), initial_traction.end(), traction.begin());
  return traction;
}

laws::JointParameters PointPath::joint_of(const physics::Material& from) const {
  auto joint = from.joint({});
  std::copy(plastic_jump.begin(), plastic_jump.end(), joint.plastic_jump.begin());
  joint.slip_path = slip_path;
  return joint.in_situ ? laws::unloaded(joint, start_traction(), static_cast<int>(control.size())) : joint;
}

void PointScene::describe(base::Section& s) {
  s.named_sections(tables, "Tables", "piecewise linear functions for use in expressions by name");
  s.named_expressions(expressions, "Expressions", "named expressions for use in all other expressions");
  s.expressions_call(tables, expressions);
  s.named_sections(materials, "Materials", "joint materials by names of your choice");
  s.section(time, "Time", "time steps of the run");
  std::optional<PointPath> one;
  s.section(one, "Point", "path of the joint at one point");
  s.named_sections(specimens, "Specimens",
                   "paths of several points, by names of your choice, in place of the section Point");
  if (!s.complete()) return;
  if (time.newton_iterations)
    s.fail_inside("Time: chooses steps by \"target Newton iterations\", which needs a mesh; leave it out");
  if (one && !specimens.empty()) s.fail_inside("Specimens: given in addition to \"Point\"; leave one of them out");
  if (!one && specimens.empty())
    s.fail_inside("Point: missing, and so are \"Specimens\"; a scene of points needs either");
  if (one) point = *one;
  for (const auto& [place, path] : paths()) check_material(s, place, *path);
}

void PointScene::check_material(base::Section& s, const std::string& place, const PointPath& path) {
  physics::add_library_materials(materials, {path.material});
  const std::string wrong = physics::wrong_material(path.material, "joint", materials);
  if (!wrong.empty()) s.fail_inside(fmt::format("{} > \"material\": {}", place, wrong));
  if (!wrong.empty()) return;
  if (time.tolerance && !materials.at(path.material).depends_on_rate())
    s.fail_inside(fmt::format(
        "Time: chooses steps by \"tolerance\", which needs a mesh or friction that depends on the slip rate; "
        "{} > \"material\" has friction \"{}\". Give \"steps\" or a \"schedule\"",
        place, materials.at(path.material).friction));
  if (materials.at(path.material).is_in_situ() && path.initial_traction.empty())
    s.fail_inside(
        fmt::format("{} > \"initial traction\": missing; it is required with the \"reference state\" {} of "
                    "the joint",
                    place, materials.at(path.material).reference_state));
  if (materials.at(path.material).bond == laws::SharpFrontBond::name)
    s.fail_inside(
        fmt::format("Materials > {} > \"bond\": is \"{}\", whose strengths follow from the faces of a mesh; "
                    "give \"linear softening\" with strengths",
                    path.material, laws::SharpFrontBond::name));
  if (path.slip_path > 0 && !materials.at(path.material).is_in_situ())
    s.fail_inside(fmt::format("{} > \"slip path\": requires the \"reference state\" in situ of the joint", place));
  if (path.control.size() != 3) return;
  for (const auto& [entry, what] : materials.at(path.material).only_in_2d())
    s.fail_inside(fmt::format("Materials > {} > \"{}\": {}", path.material, entry, what));
}

std::vector<std::pair<std::string, const PointPath*>> PointScene::paths() const {
  std::vector<std::pair<std::string, const PointPath*>> all;
  for (const auto& [name, path] : specimens) all.emplace_back("Specimens > " + name, &path);
  if (all.empty()) all.emplace_back("Point", &point);
  return all;
}

PointScene read_point_scene(const Comm& comm, const std::string& path, const std::vector<std::string>& overrides) {
  return point_scene_of(base::read_xml(comm, path, "Sprekk", base::Defects::keep), path, overrides);
}

PointScene point_scene_of(Teuchos::ParameterList entries, const std::string& origin,
                          const std::vector<std::string>& overrides) {
  SPREKK_CHECK(entries.isParameter("Point") || entries.isParameter("Specimens") || !entries.isParameter("Bulk"),
               "{}: is a scene for `sprekk run`: it has the section \"Bulk\" and no \"Point\"", origin);
  const auto errors = base::apply_overrides(entries, origin, overrides);
  auto scene = base::read<PointScene>(entries, origin, "Sprekk", errors);
  scene.file = origin;
  return scene;
}

std::vector<PointCurve> drive_points(const PointScene& scene) {
  std::vector<PointCurve> curves;
  for (const auto& [place, path] : scene.paths()) {
    const auto& material = scene.materials.at(path->material);
    auto curve =
        path->control.size() == 2 ? drive<2>(*path, material, scene.time) : drive<3>(*path, material, scene.time);
    if (!curve.failure.empty()) curve.failure = fmt::format("{}: Sprekk > {}: {}", scene.file, place, curve.failure);
    if (!scene.specimens.empty()) curve.specimen = place.substr(std::string("Specimens > ").size());
    curves.push_back(std::move(curve));
  }
  return curves;
}

std::vector<PointState> drive_point(const PointScene& scene) {
  auto curves = drive_points(scene);
  SPREKK_CHECK(curves.size() == 1, "{}: has {} specimens, not one point", scene.file, curves.size());
  SPREKK_CHECK(curves[0].failure.empty(), "{}", curves[0].failure);
  return std::move(curves[0].states);
}

void write_csv(std::ostream& out, const std::vector<PointCurve>& curves) {
  std::size_t dim = 2;
  bool are_named = false;
  std::vector<std::string> quantities;
  for (const auto& curve : curves) {
    dim = std::max(dim, curve.initial.jump.size());
    are_named = are_named || !curve.specimen.empty();
    for (const auto& name : curve.quantities)
      if (std::find(quantities.begin(), quantities.end(), name) == quantities.end()) quantities.push_back(name);
  }
  out << (are_named ? "specimen,t,state" : "t,state");
  for (const char* name : {"jump", "elastic_jump", "plastic_jump", "traction"})
    for (std::size_t i = 0; i < dim; ++i) out << ',' << name << '_' << axis(dim, i);
  out << ",strength,aperture";
  for (auto name : quantities) {
    std::replace(name.begin(), name.end(), ' ', '_');
    out << ',' << name;
  }
  out << '\n';
  const auto write = [&](const PointCurve& curve, const PointState& s) {
    if (are_named) out << in_quotes(curve.specimen) << ',';
    out << fmt::format("{:.17g},{}", s.t, static_cast<int>(s.contact));
    for (const auto* values : {&s.jump, &s.elastic, &s.plastic, &s.traction})
      for (std::size_t i = 0; i < dim; ++i) out << fmt::format(",{:.17g}", i < values->size() ? (*values)[i] : 0);
    out << fmt::format(",{:.17g},{:.17g}", s.strength, s.aperture);
    for (const auto& name : quantities) {
      const auto k = std::find(curve.quantities.begin(), curve.quantities.end(), name) - curve.quantities.begin();
      out << fmt::format(",{:.17g}", k < std::ssize(s.quantities) ? s.quantities[k] : 0);
    }
    out << '\n';
  };
  for (const auto& curve : curves) {
    if (curve.initial.jump.empty()) continue;
    write(curve, curve.initial);
    for (const auto& s : curve.states) write(curve, s);
  }
}

}  // namespace sprekk::laboratory
