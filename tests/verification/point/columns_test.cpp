// Compares each column of `sprekk point` with an independent formula, for all point scenes and for random ones. The
// test fails for a column without formula.
#include "point_scenes.hpp"

#include <filesystem>
#include <random>
#include <sstream>

namespace sprekk::tests {
namespace {

constexpr Real degree = M_PI / 180;

/// Row of the CSV file.
using Row = std::map<std::string, Real>;

std::vector<Row> rows_of(const laboratory::PointCurve& curve, std::vector<std::string>& titles) {
  std::stringstream csv;
  auto unnamed = curve;
  unnamed.specimen.clear();
  laboratory::write_csv(csv, {unnamed});
  std::string line, word;
  std::getline(csv, line);
  titles.clear();
  for (std::istringstream words(line); std::getline(words, word, ',');) titles.push_back(word);
  std::vector<Row> rows;
  while (std::getline(csv, line)) {
    std::istringstream words(line);
    rows.emplace_back();
    for (const auto& title : titles) {
      std::getline(words, word, ',');
      rows.back()[title] = std::stod(word);
    }
  }
  return rows;
}

/// Returns Barton's mobilised roughness (1982), as a function of slip over peak slip.
Real mobilised(Real x) {
  constexpr Real at[] = {0.3, 0.6, 1, 2, 4, 10, 100}, part[] = {0, 0.75, 1, 0.85, 0.7, 0.5, 0};
  if (x <= at[0] || x >= at[6]) return 0;
  int k = 0;
  while (x > at[k + 1]) ++k;
  return part[k] + (part[k + 1] - part[k]) * (x - at[k]) / (at[k + 1] - at[k]);
}

/// Formulas for a joint on a path; values in SI units, numbers of a row by column titles.
class Formulas {
 public:
  Formulas(const laboratory::PointScene& scene, const laboratory::PointPath& path)
      : path_(path), material_(scene.materials.at(path.material)), dim_(path.control.size()) {
    for (std::size_t i = 1; i < dim_; ++i) slipped_.push_back(path.plastic_jump.empty() ? 0 : path.plastic_jump[i - 1]);
    JRC_ = value("joint roughness coefficient", 0);
    JCS_ = value("joint wall strength", 1);
    const Real length = value("joint length", 0.1), scale = length / value("sample length", 0.1);
    peak_slip_ = value("peak slip", 0);
    const Real sample_JRC = JRC_;
    JRC_ *= std::pow(scale, -0.02 * sample_JRC);
    JCS_ *= std::pow(scale, -0.03 * sample_JRC);
    if (peak_slip_ == 0) peak_slip_ = length / 500 * std::pow(JRC_ / length, 0.33);
  }

  /// Begins a row; the first row is the initial state.
  void take(const Row& row, bool is_first) {
    row_ = row;
    if (is_first) first_ = row;
    moved_ = 0;
    along_.clear();
    for (std::size_t i = 1; i < dim_; ++i) along_.push_back(at("plastic_jump", i) - slipped_[i - 1]);
    for (const Real d : along_) moved_ = std::hypot(moved_, d);
    largest_ = std::max(largest_, -at("traction", 0));
  }
  /// Ends the row: its slip becomes history.
  void commit() {
    dilated_ = opening();
    if (state() != 0) path_length_ += moved_;
    for (std::size_t i = 1; i < dim_; ++i) slipped_[i - 1] = at("plastic_jump", i);
  }

  int state() const { return static_cast<int>(row_.at("state")); }
  Real length() const {
    Real size = 0;
    for (const char* part : {"jump", "elastic_jump", "plastic_jump"})
      for (std::size_t i = 0; i < dim_; ++i) size = std::max(size, std::abs(at(part, i)));
    return size;
  }
  Real stress() const {
    Real size = std::max(row_.at("strength"), stiffness() < 1e300 ? 1e-12 * stiffness() * length() : 0);
    for (std::size_t i = 0; i < dim_; ++i) size = std::max(size, std::abs(at("traction", i)));
    return size;
  }

  /// Returns the expected value of a column (i: component, -1 without); nullopt if there is no formula.
  std::optional<Real> expected(const std::string& name, int i) {
    if (name == "t") return row_.at("t");  // see TimesAreThoseOfTheScene
    if (name == "state") return state_by_motion();
    if (name == "jump") return jump(i);
    if (name == "elastic_jump") return elastic(i);
    if (name == "plastic_jump") return i == 0 ? gap() : at("jump", i) - elastic(i);
    if (name == "traction") return traction(i);
    if (name == "aperture") return material_.initial_aperture({0, 0, 0}, 0) + at("jump", 0);
    if (name == "strength") return strength();
    if (name == "slip_rate" || name == "friction_state") return row_.at(name);  // see rate_state_test.cpp
    return {};
  }

 private:
  Real at(const char* name, std::size_t i) const { return at(row_, name, i); }
  Real at(const Row& row, const char* name, std::size_t i) const {
    return row.at(fmt::format("{}_{}", name, i == 0 ? "n" : dim_ == 2 ? "t" : i == 1 ? "t1" : "t2"));
  }
  Real value(const char* entry, Real otherwise) const {
    const auto& found = material_.entry(entry);
    return found ? (*found)({0, 0, 0}, 0) : otherwise;
  }
  Real stiffness() const { return value("tangential stiffness", std::numeric_limits<Real>::infinity()); }
  Real N() const { return std::max(-at("traction", 0), Real(0)); }
  Real prescribed(std::size_t i) const { return path_.path[i]({0, 0, 0}, row_.at("t")); }
  bool is(std::size_t i, const char* control) const { return path_.control[i] == control; }
  Real column(std::size_t i) const { return i == 0 ? path_.normal_stiffness : path_.tangential_stiffness; }
  bool damaged() const { return material_.damage != "none"; }

  /// Returns the closure V(N), m.
  Real closure(Real N) const {
    const Real K = value("normal stiffness", std::numeric_limits<Real>::infinity());
    const Real maximum = material_.closure == "linear"
                             ? std::numeric_limits<Real>::infinity()
                             : value("maximum closure", std::numeric_limits<Real>::infinity());
    return maximum == 0 ? 0 : N / (K + N / maximum);
  }
  Real retained() const { return value("irrecoverable part of closure", 0); }

  Real elastic(std::size_t i) const {
    if (state() == 0) return 0;
    if (i > 0) return at("traction", i) / stiffness();
    const Real tension = std::max(at("traction", 0), Real(0));
    return tension / value("normal stiffness", 1) - (1 - retained()) * closure(N());
  }
  Real jump(std::size_t i) const {
    if (row_ == first_)
      return i > 0 ? at("plastic_jump", i) + at("traction", i) / stiffness() : at("plastic_jump", 0) + elastic(0);
    if (is(i, "jump")) return at(first_, "jump", i) + prescribed(i);
    if (is(i, "column"))
      return at(first_, "jump", i) + prescribed(i) - (at("traction", i) - at(first_, "traction", i)) / column(i);
    return at("plastic_jump", i) + elastic(i);
  }
  Real traction(std::size_t i) const {
    if (row_ == first_) return path_.initial_traction.empty() ? 0 : path_.initial_traction[i];
    if (is(i, "traction")) return prescribed(i);
    if (state() == 0) return 0;
    if (i > 0 && state() == 2 && moved_ > 0) return strength() * along_[i - 1] / moved_;
    if (is(i, "column"))
      return at(first_, "traction", i) + column(i) * (prescribed(i) - (at("jump", i) - at(first_, "jump", i)));
    return i > 0 ? stiffness() * (at("jump", i) - slipped_[i - 1]) : at("traction", 0);
  }
  /// Returns the expected contact state: slip if the plastic jump changes; zero traction is open.
  Real state_by_motion() const {
    Real shear = 0, all = std::abs(at("traction", 0));
    for (std::size_t i = 1; i < dim_; ++i) shear = std::hypot(shear, at("traction", i));
    all = std::max(all, shear);
    if (all == 0) return state();  // in contact or not
    if (row_ == first_) return 1;
    if (depends_on_rate()) return 2;
    return moved_ > 1e-9 * length() ? 2 : 1;
  }

  /// Returns the opening by slip, m.
  Real opening() const {
    Real distance = 0, before = 0;
    for (std::size_t i = 1; i < dim_; ++i) {
      distance = std::hypot(distance, at("plastic_jump", i));
      before = std::hypot(before, slipped_[i - 1]);
    }
    if (material_.dilation != "mobilised") return std::tan(value("dilation angle", 0) * degree) * distance;
    const Real steep =
        degree * JRC_ * std::log10(JCS_ / std::max(N(), 1e-6 * JCS_)) / value("asperity damage coefficient", 2);
    Real mean = 0;
    constexpr int n = 20000;
    for (int k = 0; k < n; ++k)
      mean += std::tan(mobilised((path_length_ + (k + 0.5) / n * moved_) / peak_slip_) * steep) / n;
    return dilated_ + mean * (distance - before);
  }
  /// Returns the normal plastic jump of closed faces by formula. For open faces and with damage: jump minus elastic
  /// jump.
  Real gap() const {
    if (state() == 0 || damaged() || at("traction", 0) >= 0) return at("jump", 0) - elastic(0);
    return material_.initial_gap({0, 0, 0}, 0) + opening() - retained() * closure(largest_);
  }

  Real strength() const {
    if (material_.bond != "none" || damaged() || material_.friction == "composed")
      return state() == 2 ? shear() : row_.at("strength");
    if (depends_on_rate()) return N() > 0 ? N() * rated_coefficient() + value("radiation damping", 0) * rate() : 0;
    const Real s = path_length_ + (state() == 0 ? 0 : moved_);
    return N() * coefficient(s);
  }
  bool depends_on_rate() const { return material_.friction.starts_with("rate and state"); }
  Real rate() const { return row_.at("slip_rate"); }
  /// Returns the friction coefficient at the slip rate and state of the row.
  Real rated_coefficient() const {
    const Real a = value("direct effect", 0), V0 = value("reference slip rate", 1e-6),
               x = V0 * row_.at("friction_state") / value("state evolution distance", 1),
               psi = value("reference friction coefficient", 0.6) + value("evolution effect", 0) * std::log(x);
    return a * std::asinh(rate() / (2 * V0) * std::exp(psi / a));
  }
  Real shear() const {
    Real size = 0;
    for (std::size_t i = 1; i < dim_; ++i) size = std::hypot(size, at("traction", i));
    return size;
  }
  Real coefficient(Real s) const {
    const auto kind = material_.friction;
    const Real mu = material_.entry("friction angle") ? std::tan(degree * value("friction angle", 0))
                                                      : value("friction coefficient", 0);
    if (kind == "slip weakening") {
      const Real residual = material_.entry("residual friction angle")
                                ? std::tan(degree * value("residual friction angle", 0))
                                : value("residual friction coefficient", 0);
      return residual + (mu - residual) * std::max(1 - s / value("weakening distance", 1), Real(0));
    }
    if (kind == "Coulomb") return mu;
    const Real phi = value("residual friction angle", 30), maximum = value("largest friction angle", 70) - phi;
    const Real rough = N() > 0 ? std::clamp(JRC_ * std::log10(JCS_ / N()), Real(0), maximum) : maximum;
    if (kind == "Barton-Choubey") return std::tan(degree * (phi + rough));
    const Real x = s / peak_slip_;
    return std::tan(degree * (phi * std::min(x / 0.3, Real(1)) + rough * mobilised(x)));
  }

  const laboratory::PointPath& path_;
  const model::Material& material_;
  std::size_t dim_;
  Row row_, first_;
  std::vector<Real> slipped_, along_;  // plastic jump before the row; slip of the row
  Real JRC_, JCS_, peak_slip_, moved_ = 0, path_length_ = 0, largest_ = 0, dilated_ = 0;
};

/// Number of comparisons per column.
using Counts = std::map<std::string, int>;

/// Compares all columns. Values at the points of Barton's table are rounded within 1e-3 of the roughness.
void expect_columns(const laboratory::PointScene& scene, Counts& counts) {
  const auto curves = laboratory::drive_points(scene);
  const auto paths = scene.paths();
  for (std::size_t c = 0; c < curves.size(); ++c) {
    SCOPED_TRACE(paths[c].first);
    const auto& material = scene.materials.at(paths[c].second->material);
    const Real rounding = material.friction == "mobilised Barton-Choubey" ? 1e-3 : 1e-9;
    std::vector<std::string> titles;
    Formulas formulas(scene, *paths[c].second);
    const auto rows = rows_of(curves[c], titles);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      formulas.take(rows[r], r == 0);
      for (const auto& title : titles) {
        const auto end = title.rfind('_');
        const std::string axis = end == std::string::npos ? "" : title.substr(end + 1);
        const int i = axis == "n" ? 0 : axis == "t" || axis == "t1" ? 1 : axis == "t2" ? 2 : -1;
        const auto name = i < 0 ? title : title.substr(0, end);
        const auto expected = formulas.expected(name, i);
        ASSERT_TRUE(expected) << "the column " << title << " has no formula here";
        const Real size = name == "state" || name == "t"                         ? 1
                          : name == "aperture" || (i >= 0 && name != "traction") ? formulas.length()
                                                                                 : formulas.stress();
        const bool rough = name == "strength" || name == "traction";
        EXPECT_NEAR(rows[r].at(title), *expected, (rough ? rounding : 1e-7) * size + 1e-300)
            << title << " in row " << r << " at t = " << rows[r].at("t");
        ++counts[title];
      }
      formulas.commit();
      if (testing::Test::HasFailure()) return;
    }
  }
}

TEST(Columns, OfAllScenesFollowTheirFormulas) {
  Counts counts;
  for (const auto& file : std::filesystem::directory_iterator(source_dir() + "/xml/point")) {
    SCOPED_TRACE(file.path().string());
    expect_columns(read(file.path().filename()), counts);
  }
  for (const char* title : {"t", "state", "jump_n", "jump_t", "jump_t2", "elastic_jump_n", "plastic_jump_t1",
                            "traction_t2", "strength", "aperture"})
    EXPECT_GT(counts[title], 50) << title;
}

/// The rows are at the times of the scene. Each slip jump adds at most two rows.
TEST(Columns, TimesAreThoseOfTheScene) {
  for (const auto& file : std::filesystem::directory_iterator(source_dir() + "/xml/point")) {
    SCOPED_TRACE(file.path().string());
    const auto scene = read(file.path().filename());
    for (const auto& curve : laboratory::drive_points(scene)) {
      EXPECT_EQ(curve.initial.t, scene.time.start);
      const auto times = scene.time.times();
      std::size_t k = 0, others = 0, jumps = 0;
      for (const auto& s : curve.states) {
        jumps += !s.remark.empty();
        k < times.size() && s.t == times[k] ? ++k : ++others;
      }
      if (!scene.time.tolerance) {
        EXPECT_LE(others, 2 * jumps);
      }
      if (curve.failure.empty()) EXPECT_EQ(k, times.size());
    }
  }
}

/// Random stiffnesses, angles and paths, in 2D and 3D.
TEST(Columns, OfRandomScenesFollowTheirFormulas) {
  std::mt19937 random(20261129);
  const auto uniform = [&](Real low, Real high) { return std::uniform_real_distribution<Real>(low, high)(random); };
  Counts counts;
  for (int k = 0; k < 100; ++k) {
    const bool flat = random() % 2 == 0;
    const auto set = [](const char* entry, Real value) { return fmt::format("{}={:.17g}", entry, value); };
    const std::vector<std::string> overrides = {
        set("Materials.joint.tangential stiffness", std::pow(10, uniform(-1, 2))),
        set("Materials.joint.normal stiffness", std::pow(10, uniform(0, 2))),
        set("Materials.joint.maximum closure", uniform(0.1, 1)),
        set("Materials.joint.friction coefficient", uniform(0.3, 1)),
        set("Materials.joint.dilation angle", uniform(0, 15)),
        set("Materials.joint.initial gap", uniform(-0.05, 0.05)),
        set("Point.column normal stiffness", std::pow(10, uniform(-1, 1))),
        set("Point.column tangential stiffness", std::pow(10, uniform(-1, 1))),
        "Time.end=6",
        fmt::format("Time.steps={}", 10 + random() % 50),
        fmt::format("Point.control={{{}, {}{}}}", random() % 2 ? "column" : "traction",
                    random() % 2 ? "column" : "jump",
                    flat           ? ""
                    : random() % 2 ? ", column"
                                   : ", jump"),
        fmt::format("Point.path={{{:.6g}*(sin(t) - 1.01), {:.6g}*sin({:.6g}*t){}}}", uniform(0.01, 0.5),
                    uniform(0.1, 1), uniform(0.5, 3),
                    flat ? "" : fmt::format(", 0.5*sin({:.6g}*t + 1)", uniform(0.5, 3)))};
    SCOPED_TRACE(fmt::format("case {}: {}", k, fmt::join(overrides, "; ")));
    expect_columns(read(flat ? "cyclic_shear.xml" : "turning_shear.xml", overrides), counts);
    if (HasFailure()) return;
  }
  EXPECT_GT(counts["strength"], 2000);
}

}  // namespace
}  // namespace sprekk::tests
