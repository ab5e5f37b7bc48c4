#include "model/steps.hpp"

#include "model/knots.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::model {

namespace {

bool contains(const std::vector<Real>& increasing, Real t) {
  return std::binary_search(increasing.begin(), increasing.end(), t);
}

}  // namespace

Steps::Steps(Model& model) : model_(model), times_(model.scene().time.times()), stages_(staged_scenes(model.scene())) {
  const auto& scene = model.scene();
  const auto end = times_.back();
  for (auto& stage : stages_)
    if (stage.time < end) add_time(stage.time);
  find_next();
  if (!scene.time.chooses_steps()) return;
  knots_ = knots(scene, end);
  for (const auto& stage : stages_)
    for (const Real knot : knots(stage.draft.value, end))
      if (knot > stage.time) knots_.push_back(knot);
  for (const auto& [name, stage] : scene.stages)
    if (stage.release && stage.time + *stage.release < end) knots_.push_back(stage.time + *stage.release);
  std::sort(knots_.begin(), knots_.end());
  for (Real& knot : knots_)  // replaces a knot by a time if they differ only by rounding
    for (const Real t : times_)
      if (is_close(knot, t)) knot = t;
  auto stops = times_;
  stops.insert(stops.end(), knots_.begin(), knots_.end());
  std::sort(stops.begin(), stops.end());
  control_.emplace(scene.time.control(model.system().has_rates(), model.system().evolves()), stops);
}

namespace {

/// Returns true if `end` is later than t, apart from rounding.
bool is_ahead(Real end, Real t, Real start) { return end - t > 1e-14 * std::max(std::abs(end), std::abs(start)); }

}  // namespace

bool Steps::is_close(Real a, Real b) const {
  return std::abs(a - b) <= 1e-12 * (times_.back() - model_.scene().time.start);
}

/// Adds t to the times that must be met. If it equals one of them apart from rounding, t is set to this time instead.
void Steps::add_time(Real& t) {
  for (const Real other : times_)
    if (is_close(t, other)) {
      t = other;
      return;
    }
  times_.insert(std::upper_bound(times_.begin(), times_.end(), t), t);
}

/// Finds the first time later than that of the model.
void Steps::find_next() {
  while (next_ < times_.size() && !is_ahead(times_[next_], model_.time(), model_.scene().time.start)) ++next_;
}

/// Begins the stages before t, with `also_now` also the stage at t. Returns true if a stage began.
bool Steps::begin_stages(Real t, bool also_now) {
  const auto before = n_begun_;
  const Real start = model_.scene().time.start;
  for (; n_begun_ < stages_.size(); ++n_begun_) {
    const auto& stage = stages_[n_begun_];
    if (is_ahead(stage.time, t, start) || (!also_now && !is_ahead(t, stage.time, start))) break;
    model_.change(stage.draft.value);
  }
  return n_begun_ > before;
}

void Steps::go_to_stage_at(Real t, bool begun) {
  begin_stages(t, begun);
  begun_before_ = begun;
}

bool Steps::is_at_begin_of_stage() const { return n_begun_ > 0 && is_close(stages_[n_begun_ - 1].time, model_.time()); }

Real Steps::share_done() const {
  const auto& time = model_.scene().time;
  const Real end = times_.back();
  return (model_.time() - time.start) / (end - time.start);
}

StepTaken Steps::take() {
  const bool begins = begin_stages(model_.time(), true) || begun_before_;
  begun_before_ = false;
  before_ = {next_, begins, control_};
  StepTaken step;
  if (control_) {
    if (begins) change_course();
    step = choose();
  } else {
    step = {.begin = model_.time(), .end = times_[next_]};
    step.report = model_.step_to(step.end);
    find_next();
  }
  step.stage = stage();
  step.begins_stage = begins;
  return step;
}

void Steps::take_back() {
  model_.take_back();
  next_ = before_.next;
  begun_before_ = before_.begins;
  control_ = before_.control;
}

/// Restarts the control of adaptive steps where loads or their slopes are discontinuous.
void Steps::change_course() {
  if (!model_.system().has_rates()) return;
  control_->be_careful(model_.time());
  model_.system().forget_rates(true);
}

/// Returns the end of the next step and the deviation of its loads from linear variation. The step is shortened if
/// loads deviate too much and shortening helps.
std::pair<Real, Real> Steps::next_attempt() {
  const auto scope = model_.timers().scope("choice of steps");
  const Real t = model_.time();
  const auto& tolerance = model_.scene().time.tolerance;
  for (Real before = 2;;) {
    const Real end = control_->end_of_step(t);
    const Real bend = tolerance ? model_.system().bend_of_loads(model_.state(), end, end - t) : 0;
    if (!tolerance || bend <= *tolerance || bend > 0.8 * before) return {end, bend};
    before = bend;
    control_->shorten(end - t, bend);
  }
}

namespace {

/// Warning about an accepted step of length dt with errors above the tolerance.
std::string limit_of_steps(Real dt, const StepTaken& step) {
  const auto worst = std::max_element(step.errors.begin(), step.errors.end(),
                                      [](const auto& a, const auto& b) { return a.value < b.value; });
  return fmt::format(
      "the step of length {:.6g} is accepted with a relative error of {:.2g} of '{}', above Time > "
      "\"tolerance\", after {} rejected attempts: {}",
      dt, worst->value, worst->name, step.n_rejected,
      step.n_rejected < solve::StepControl::max_rejections ? "shorter ones are below Time > \"smallest step\""
                                                           : "there were too many in a row");
}

}  // namespace

StepTaken Steps::choose() {
  using Verdict = solve::StepControl::Verdict;
  auto& system = model_.system();
  const auto before = *control_;
  StepTaken step{.begin = model_.time()};
  for (;;) {
    const auto [end, bend] = next_attempt();
    step.end = end;
    step.report = model_.step_to(end);
    step.errors = system.take_errors();
    step.errors.push_back({"loads", bend, 2});
    if (step.report.stopped) control_ = before;
    if (!step.report.converged) return step;
    const Real dt = (step.end - step.begin) / std::max(1, step.report.substeps);
    const auto verdict = control_->judge(dt, step.errors, step.report.newton_iterations);
    if (verdict == Verdict::jumped || verdict == Verdict::limited) system.forget_rates(true);
    if (verdict == Verdict::limited) step.warning = limit_of_steps(dt, step);
    std::erase_if(step.errors, [](const auto& error) { return error.order == fields::StepError::unknown; });
    if (verdict != Verdict::rejected) break;
    const auto scope = model_.timers().scope("choice of steps");
    model_.take_back();
    ++step.n_rejected;
    step.rejected_iterations += step.report.newton_iterations;
  }
  step.at_time = contains(times_, step.end);
  if (system.has_rates() && contains(knots_, step.end)) {
    control_->be_careful(step.end);
    system.forget_rates(false);
  }
  find_next();
  return step;
}

nlohmann::json Steps::memory() const {
  if (!control_) return nullptr;
  const auto& memory = control_->memory();
  return {memory.length, memory.judged, memory.judged_iterations};
}

void Steps::resume(const nlohmann::json& memory) {
  if (control_ && !memory.is_null())
    control_->resume({memory[0].get<Real>(), memory[1].get<Real>(), memory[2].get<int>()});
  find_next();
}

}  // namespace sprekk::model
