// Adaptive refinement to the tolerances of the section Accuracy: repeated runs on finer meshes, and a report of the
// result.
#pragma once

#include "estimate/goals.hpp"
#include "model/error_estimates.hpp"

#include <nlohmann/json.hpp>

#include <chrono>

namespace sprekk::model {

/// Data of the runs so far. All members are collective unless they return stored data.
class Adaptation {
 public:
  /// Report on one quantity.
  struct Verdict {
    std::string name, title, unit;
    Real value, error;  ///< infinite: unknown
    Real space, time;   ///< parts of the error due to the mesh and to the time steps
    Real requested;
    bool reached;
    /// Text `QUANTITY of "fault": 0.00321 m +- 2.1e-05 (0.65 %, requested 1 %), space 1.8e-05, time 3e-06`.
    std::string line() const;
  };

  Adaptation() : bisection_(std::make_shared<std::optional<mesh::Bisection>>()) {}

  /// Sets the present mesh and time steps in `scene`, from which the next model is built. With repeated runs, the first
  /// call chooses the steps on the mesh of the scene. It halves them until quantities change by less than 0.15 of their
  /// tolerance, or six times.
  void prepare(Scene& scene, RCP<const Comm> comm);

  /// Returns the cells to be bisected before the step from `begin` is repeated, on all ranks; empty: the errors of the
  /// step meet the tolerances, a limit is reached, or the mesh is not refined during the run. In a repeated step, the
  /// errors include the bounds from the previous mesh. `estimates`: of this mesh; they receive that of the step.
  std::vector<GlobalIndex> cells_for_step(Model& model, Real begin, RunEstimates& estimates);

  /// Evaluates a completed run. The spatial error of a quantity is the maximum of its estimate and of bounds from the
  /// previous mesh. One bound is proportional to the change of the value. Tolerances can be met from the second mesh
  /// on. After refinement during the run, the spatial error is the estimate on the last mesh, and the error of the time
  /// steps is unknown and not included.
  void judge(const Model& model, const estimate::Goals& goals);
  /// Returns true if another run is needed; otherwise why() contains the reason.
  bool goes_on() const { return why_.empty(); }
  const std::string& why() const { return why_; }
  bool reached() const;
  bool is_first() const { return runs_.empty(); }
  const std::vector<Verdict>& verdicts() const { return verdicts_; }
  /// Entry "accuracy" of results.json. Stored data.
  nlohmann::json summary() const;
  /// Meshes so far and the seconds since the first run began, for a checkpoint. Stored data.
  nlohmann::json memory() const;
  /// Continues with the memory of an earlier run, the same on all ranks. Call it before the first step.
  void resume(const nlohmann::json& memory);

  /// Bisects the cells selected by judge(). Call it after the last use of the model.
  void refine(const Comm& comm);

 private:
  /// Results of one run, or of one attempt of a step that is repeated.
  struct Run {
    GlobalIndex cells;
    Real seconds;  ///< since the first run began
    Real begin;    ///< of the run or step, s
    std::map<std::string, estimate::Estimate> estimates;
  };

  Real elapsed() const;
  nlohmann::json meshes() const;
  void record(const Model& model, const estimate::Goals& goals, Real begin);
  void choose_steps(Scene scene, RCP<const Comm> comm);
  Real space_error(const estimate::Estimate& now, const estimate::Estimate& before) const;
  std::vector<GlobalIndex> cells_to_halve(const Model& model, const estimate::Goals& goals) const;
  static std::vector<GlobalIndex> marked(const Model& model, const estimate::Goals& goals,
                                         const std::map<std::string, Real>& weights);
  std::string limit(const Accuracy& accuracy, const Comm& comm) const;

  std::shared_ptr<std::optional<mesh::Bisection>> bisection_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  Real earlier_seconds_ = 0;                 // of the runs before a restart
  std::optional<Time> time_;                 // chosen time steps
  std::map<std::string, Real> time_errors_;  // by quantity; empty if a step failed
  std::vector<Run> runs_;
  std::vector<Verdict> verdicts_;
  std::vector<GlobalIndex> cells_;  // cells to be bisected, of all ranks
  int dim_ = 0, order_ = 0;         // of the mesh
  std::string why_;
};

}  // namespace sprekk::model
