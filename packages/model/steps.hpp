// Time steps of a run: prescribed by the scene or adaptive.
#pragma once

#include "estimate/state_table.hpp"
#include "model/model.hpp"
#include "solve/step_control.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <utility>
#include <vector>

namespace sprekk::model {

/// Accepted step.
struct StepTaken {
  solve::StepReport report = {};
  Real begin = 0, end = 0;               ///< planned begin and end, s
  bool at_time = true;                   ///< ends at a time given by the scene
  std::string stage = "";                ///< stage of the step; empty before the first stage
  bool begins_stage = false;             ///< the model changed before this step
  fields::StepErrors errors = {};        ///< relative errors of adaptive steps
  int n_rejected = 0;                    ///< rejected attempts
  int rejected_iterations = 0;           ///< Newton iterations in rejected attempts
  std::string warning = "";              ///< set if the error exceeds its tolerance
  estimate::StateTable extensions = {};  ///< of fractures, as in Tips::extensions()
  /// Growth of fractures, see Tips::growth()
  nlohmann::json growth = nlohmann::json::object();
};

/// Driver of a model through the section Time of its scene. A host with adaptive steps uses it as a run does. Members
/// are collective unless they return stored data.
class Steps {
 public:
  /// Begins at the present state of the model, to which it refers.
  explicit Steps(Model& model);

  bool any() const { return next_ < times_.size(); }  ///< steps remain
  Real share_done() const;                            ///< completed fraction of the time from start to end
  int n_left() const { return control_ ? 0 : static_cast<int>(times_.size() - next_); }  ///< 0 for adaptive steps
  /// Takes the next step; rejected attempts are reverted. The report shows whether the step failed or was stopped.
  StepTaken take();
  /// Reverts the last step, so that take() repeats it. The step must have converged.
  void take_back();

  /// Applies the stages before t to a model that will be restored to time t. With `begun`, it also applies the stage
  /// that begins at t.
  void go_to_stage_at(Real t, bool begun);
  /// Returns true if the present stage begins at the present time and has no step yet.
  bool is_at_begin_of_stage() const;
  /// Last stage that has begun; empty if there is none.
  std::string stage() const { return n_begun_ > 0 ? stages_[n_begun_ - 1].name : ""; }

  /// Data besides the model that determine the length of the next step.
  nlohmann::json memory() const;
  void resume(const nlohmann::json& memory);  ///< for a model restored to another time

 private:
  bool is_close(Real a, Real b) const;
  void add_time(Real& t);
  void find_next();
  bool begin_stages(Real t, bool also_now);
  StepTaken choose();
  void change_course();
  std::pair<Real, Real> next_attempt();

  Model& model_;
  std::vector<Real> times_, knots_;            // times that must be met; those at which the slope of loads changes
  std::size_t next_ = 0;                       // index of the next entry of times_
  std::vector<StagedScene> stages_;            // ordered by time
  std::size_t n_begun_ = 0;                    // number of begun stages
  bool begun_before_ = false;                  // the next step begins a stage that has begun already
  std::optional<solve::StepControl> control_;  // control of adaptive steps
  struct {
    std::size_t next = 0;
    bool begins = false;
    std::optional<solve::StepControl> control;
  } before_;  // data at the begin of the last step
};

}  // namespace sprekk::model
