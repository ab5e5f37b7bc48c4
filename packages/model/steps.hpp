// The time steps of a run: those of its scene, or chosen as it goes.
#pragma once

#include "model/model.hpp"
#include "solve/step_control.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <utility>
#include <vector>

namespace sprekk::model {

/// A step that a run keeps.
struct StepTaken {
  solve::StepReport report = {};
  Real begin = 0, end = 0;         ///< end: where it was to end
  bool at_time = true;             ///< it ends at a time that the scene names
  std::string stage = "";          ///< that it belongs to; empty: none has begun
  bool begins_stage = false;       ///< the model has changed before it
  fields::StepErrors errors = {};  ///< relative, of steps that are chosen
  int n_rejected = 0;              ///< attempts that were taken back
  int rejected_iterations = 0;     ///< of Newton's method in them
  std::string warning = "";        ///< where it errs more than it should
};

/// Takes a model through the section Time of its scene. A host that lets steps be chosen uses it as a run does.
/// Members are collective unless they return stored data.
class Steps {
 public:
  /// From the model's present state; it is referred to.
  explicit Steps(Model& model);

  bool any() const { return next_ < times_.size(); }  ///< that are ahead
  Real share_done() const;                            ///< of the time from start to end
  int n_left() const { return control_ ? 0 : static_cast<int>(times_.size() - next_); }  ///< 0 if they are chosen
  /// Takes the next step, and those that are rejected back. Where one fails or is stopped, so says the report.
  StepTaken take();

  /// Brings the model to the stage at time t, of a model that is to be brought to a state there; `begun`: if a stage
  /// begins then, to that.
  void go_to_stage_at(Real t, bool begun);
  /// Whether the present stage begins at the present time: no step of it is taken.
  bool is_at_begin_of_stage() const;
  /// The last stage that has begun; empty: none.
  std::string stage() const { return n_begun_ > 0 ? stages_[n_begun_ - 1].name : ""; }

  /// What the next step's length depends on besides the model.
  nlohmann::json memory() const;
  void resume(const nlohmann::json& memory);  ///< of a model that was brought to another time

 private:
  bool is_close(Real a, Real b) const;
  void add_time(Real& t);
  void find_next();
  bool begin_stages(Real t, bool also_now);
  StepTaken choose();
  void change_course();
  std::pair<Real, Real> next_attempt();

  Model& model_;
  std::vector<Real> times_, knots_;            // that must be met; of them, where loads turn
  std::size_t next_ = 0;                       // of times_, that is ahead
  std::vector<StagedScene> stages_;            // by their times
  std::size_t n_begun_ = 0;                    // of them
  bool begun_before_ = false;                  // the next step begins a stage, to which the model was brought
  std::optional<solve::StepControl> control_;  // of steps that are chosen
};

}  // namespace sprekk::model
