#include "model/adaptation.hpp"

#include "base/over_ranks.hpp"
#include "model/steps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprekk::model {

using nlohmann::json;

namespace {

constexpr int max_meshes = 60;       // of a run, or of the attempts of a step
constexpr Real marked_share = 0.5;   ///< share of the indicator sum in the marked cells
constexpr Real share_of_time = 0.3;  ///< of the tolerance
constexpr int max_halvings = 6;      ///< of time steps

/// Converts unknown (infinite) values to null.
json number(Real value) { return std::isfinite(value) ? json(value) : json(); }

std::string percent(Real part, Real whole) {
  return whole != 0 && std::isfinite(part) ? fmt::format("{:.2g} %", 100 * part / std::abs(whole)) : "-";
}

}  // namespace

std::string Adaptation::Verdict::line() const {
  const auto size = [](Real x) { return std::isfinite(x) ? fmt::format("{:.2g}", x) : std::string("unknown"); };
  const bool known = std::isfinite(error) && error > 0 && value != 0;  // two digits of the error
  const int digits = known ? static_cast<int>(std::ceil(std::log10(std::abs(value) / error))) + 2 : 4;
  return fmt::format("{}: {:.{}g} {} +- {} ({}, requested {}), space {}, time {}", title, value,
                     std::clamp(digits, 4, 12), unit, size(error), percent(error, value), percent(requested, value),
                     size(space), size(time));
}

namespace {

/// Returns a schedule with each step divided into two.
Time halved(const Time& time) {
  Time result = time;
  if (!time.schedule) {
    result.steps = 2 * time.steps.value_or(1);
    return result;
  }
  result.schedule->clear();
  Real before = time.start;
  for (const Real t : *time.schedule) {
    result.schedule->insert(result.schedule->end(), {(before + t) / 2, t});
    before = t;
  }
  return result;
}

/// Returns the values of the quantities at the end of the scene; empty if a step fails. Collective.
std::map<std::string, Real> values_at_end(const Scene& scene, RCP<const Comm> comm) {
  Model model(scene, comm);
  Steps steps(model);
  while (steps.any())
    if (!steps.take().report.converged) return {};
  auto estimator = make_error_estimator(model, model.setting().start);
  const auto& quantities = scene.accuracy->quantities;
  estimate::Goals goals(estimator, scene.accuracy->functionals());
  const auto outputs = model.system().outputs(model.state());
  const auto state = present_state(model, outputs);
  const bool any_norm =
      std::any_of(quantities.begin(), quantities.end(), [](const auto& q) { return q.second.is_norm(); });
  goals.add(state, any_norm ? estimator(state) : estimate::ErrorEstimate(), true);
  std::map<std::string, Real> values;
  for (const auto& [name, estimate] : goals.estimates()) values[name] = estimate.value;
  return values;
}

}  // namespace

/// Chooses the time steps. For implicit Euler the error is proportional to the step. The change by halving is then half
/// of the error before and all of the error after halving. The tolerated time error is share_of_time of the tolerance.
void Adaptation::choose_steps(Scene scene, RCP<const Comm> comm) {
  auto values = values_at_end(scene, comm);
  for (int k = 0; k < max_halvings && !values.empty(); ++k) {
    Scene finer = scene;
    finer.time = halved(scene.time);
    const auto others = values_at_end(finer, comm);
    if (others.empty()) break;
    bool enough = true;
    for (const auto& [name, quantity] : scene.accuracy->quantities) {
      const Real change = std::abs(others.at(name) - values.at(name));
      enough = enough && 2 * change <= share_of_time * quantity.requested(others.at(name));
      time_errors_[name] = change;
    }
    if (enough) {
      for (auto& [name, error] : time_errors_) error *= 2;
      break;
    }
    scene = std::move(finer);
    values = others;
  }
  time_ = scene.time;
}

void Adaptation::prepare(Scene& scene, RCP<const Comm> comm) {
  scene.bisection = bisection_;
  if (scene.accuracy->refines_during_run()) return;
  if (!time_) choose_steps(scene, comm);
  scene.time = *time_;
}

/// Computes the spatial error e_k. Assumption: errors e decrease by the factor r = E_k / E_(k-1) of their estimates E.
/// The value then changes by e_(k-1) - e_k, so e_k is r / (1 - r) times the change. r is limited to [1/3, 2/3]. A
/// decrease of the estimate below 2^-order in one refinement may be accidental and is not accepted immediately.
Real Adaptation::space_error(const estimate::Estimate& now, const estimate::Estimate& before) const {
  const Real change = std::abs(now.value - before.value);
  const Real falls = before.error > 0 ? now.error / before.error : 1;
  const Real r = std::isfinite(falls) ? std::clamp<Real>(falls, 1.0 / 3, 2.0 / 3) : 2.0 / 3;
  return std::max({now.error, before.error * std::exp2(-order_), r / (1 - r) * change});
}

bool Adaptation::reached() const {
  return std::all_of(verdicts_.begin(), verdicts_.end(), [](const auto& verdict) { return verdict.reached; });
}

/// Returns a limit that would be exceeded on a finer mesh, extrapolated from the last run; empty if there is none.
std::string Adaptation::limit(const Accuracy& accuracy, const Comm& comm) const {
  const auto& run = runs_.back();
  const Real took = run.seconds - (runs_.size() > 1 ? runs_[runs_.size() - 2].seconds : 0);
  const Real grows =
      runs_.size() > 1 ? std::max<Real>(static_cast<Real>(run.cells) / runs_[runs_.size() - 2].cells, 1.2) : 1.5;
  const Real bytes = base::sum_over_ranks(comm, static_cast<Real>(base::peak_memory_bytes()));
  if (grows * static_cast<Real>(run.cells) > static_cast<Real>(accuracy.cells))
    return fmt::format("the next mesh would have more than {} cells (\"cells\")", accuracy.cells);
  if (accuracy.seconds && run.seconds + grows * took > *accuracy.seconds)
    return fmt::format("the next run would end after {:.3g} s (\"seconds\")", *accuracy.seconds);
  if (accuracy.memory && grows * bytes > *accuracy.memory)
    return fmt::format("the next run would need more than {:.3g} bytes (\"memory\")", *accuracy.memory);
  const auto n_meshes =
      std::count_if(runs_.begin(), runs_.end(), [&](const auto& one) { return one.begin == run.begin; });
  if (n_meshes >= max_meshes) return fmt::format("{} meshes were not enough", max_meshes);
  return "";
}

Real Adaptation::elapsed() const {
  return earlier_seconds_ + std::chrono::duration<Real>(std::chrono::steady_clock::now() - begin_).count();
}

void Adaptation::record(const Model& model, const estimate::Goals& goals, Real begin) {
  const auto& mesh = model.mesh();
  runs_.push_back({mesh.n_global_cells, base::max_over_ranks(*mesh.comm, elapsed()), begin, goals.estimates()});
  dim_ = mesh.dim();
  order_ = goals.any_balance() ? 1 : mesh::order(mesh.shape);
}

std::vector<GlobalIndex> Adaptation::cells_for_step(Model& model, Real begin, RunEstimates& estimates) {
  const auto& accuracy = model.scene().accuracy;
  if (!accuracy || !accuracy->refines_during_run() || !why_.empty()) return {};
  const auto scope = model.timers().scope("error estimate");
  const auto outputs = model.system().outputs(model.state());
  const auto state = present_state(model, outputs);
  const auto& estimate = estimates.of_step(state);
  auto& goals = *estimates.goals();
  const bool repeats = !runs_.empty() && runs_.back().begin == begin;
  std::map<std::string, Real> weights;
  for (const auto& [name, quantity] : accuracy->quantities) {
    const auto& now = goals.estimates().at(name);
    const Real error = repeats ? space_error(now, runs_.back().estimates.at(name)) : now.error;
    const Real requested = quantity.requested(now.value);
    if (requested > 0 && error > requested) weights[name] = std::isfinite(error) ? error / requested : 1;
  }
  if (weights.empty()) return {};
  record(model, goals, begin);
  why_ = limit(*accuracy, *model.mesh().comm);
  if (!why_.empty()) return {};
  goals.weigh(state, estimate, true);
  return marked(model, goals, weights);
}

void Adaptation::judge(const Model& model, const estimate::Goals& goals) {
  const auto& accuracy = *model.scene().accuracy;
  const auto& mesh = model.mesh();
  const bool during_run = accuracy.refines_during_run(), is_first = runs_.empty();
  record(model, goals, model.scene().time.start);
  verdicts_.clear();
  for (const auto& [name, quantity] : accuracy.quantities) {
    const auto& now = runs_.back().estimates.at(name);
    const bool alone = is_first || during_run;
    const Real space = alone ? now.error : space_error(now, runs_[runs_.size() - 2].estimates.at(name));
    const Real requested = quantity.requested(now.value);
    const auto known = time_errors_.find(name);
    const Real time = known == time_errors_.end() ? std::numeric_limits<Real>::infinity() : known->second;
    const Real error = during_run ? space : space + time;
    verdicts_.push_back({name, quantity.title(), quantity.unit(mesh.dim()), now.value, error, space, time, requested,
                         (during_run || !is_first) && error <= requested});
  }
  if (during_run) {
    if (reached()) why_ = "reached";
    const bool none = std::any_of(verdicts_.begin(), verdicts_.end(),
                                  [](const auto& one) { return !one.reached && one.requested == 0; });
    if (why_.empty())
      why_ = none ? "its value is zero (give the \"absolute\" error)" : "no cell has an estimated error";
    return;
  }
  const bool too_long =
      std::any_of(verdicts_.begin(), verdicts_.end(), [](const auto& v) { return v.time > v.requested; });
  why_ = reached()  ? "reached"
         : too_long ? "bisected steps fail, or change it by more than its tolerance (for a value near zero give the "
                      "\"absolute\" error)"
                    : limit(accuracy, *mesh.comm);
  if (!why_.empty()) return;
  cells_ = cells_to_halve(model, goals);
  if (cells_.empty()) why_ = "no cell has an estimated error";
}

std::vector<GlobalIndex> Adaptation::cells_to_halve(const Model& model, const estimate::Goals& goals) const {
  std::map<std::string, Real> weights;
  for (const auto& verdict : verdicts_) {
    const Real left = verdict.requested - verdict.time;
    const Real ratio = left > 0 && std::isfinite(verdict.space) ? verdict.space / left : 1;
    if (!verdict.reached) weights[verdict.name] = std::max<Real>(ratio, 1e-3);
  }
  return marked(model, goals, weights);
}

std::vector<GlobalIndex> Adaptation::marked(const Model& model, const estimate::Goals& goals,
                                            const std::map<std::string, Real>& weights) {
  const auto& mesh = model.mesh();
  std::vector<GlobalIndex> cells;
  for (const LocalIndex cell : estimate::mark_cells(*mesh.comm, goals.indicators(weights), marked_share))
    cells.push_back(mesh.origin.is_null() ? mesh.cell_id[cell] : mesh.origin->cells[cell]);
  return base::gather_over_ranks(*mesh.comm, cells);
}

void Adaptation::refine(const Comm& comm) {
  base::collectively(comm, [&] {
    if (auto& bisection = *bisection_) bisection->refine(cells_, dim_);
  });
}

json Adaptation::summary() const {
  json result = {{"reached", reached()}, {"ended", why_}, {"quantities", json::object()}, {"meshes", meshes()}};
  for (const auto& verdict : verdicts_)
    result["quantities"][verdict.name] = {
        {"title", verdict.title},         {"unit", verdict.unit},           {"value", verdict.value},
        {"error", number(verdict.error)}, {"requested", verdict.requested}, {"space", number(verdict.space)},
        {"time", number(verdict.time)},   {"reached", verdict.reached},     {"line", verdict.line()}};
  return result;
}

json Adaptation::meshes() const {
  json result = json::array();
  for (const auto& run : runs_) {
    json one = {{"cells", run.cells}, {"seconds", run.seconds}, {"quantities", json::object()}};
    for (const auto& [name, estimate] : run.estimates)
      one["quantities"][name] = {{"value", estimate.value}, {"error", number(estimate.error)}};
    result.push_back(one);
  }
  return result;
}

json Adaptation::memory() const {
  json begins = json::array();
  for (const auto& run : runs_) begins.push_back(run.begin);
  return {{"seconds", elapsed()}, {"begins", begins}, {"meshes", meshes()}, {"ended", why_}};
}

void Adaptation::resume(const json& memory) {
  earlier_seconds_ = memory.at("seconds");
  why_ = memory.value("ended", "");
  const auto& meshes = memory.at("meshes");
  for (std::size_t k = 0; k < meshes.size(); ++k) {
    runs_.push_back({meshes[k].at("cells"), meshes[k].at("seconds"), memory.at("begins")[k], {}});
    for (const auto& [name, one] : meshes[k].at("quantities").items()) {
      const auto& error = one.at("error");
      runs_.back().estimates[name] = {one.at("value"),
                                      error.is_null() ? std::numeric_limits<Real>::infinity() : error.get<Real>()};
    }
  }
}

}  // namespace sprekk::model
