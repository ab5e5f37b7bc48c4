// How a run reaches what the section Accuracy asks for: it runs on finer and finer meshes, and says how far it came.
#pragma once

#include "model/goals.hpp"

#include <chrono>

namespace sprekk::model {

/// What is known of the runs so far. All members are collective unless they return stored data.
class Adaptation {
 public:
  /// What is told of a quantity.
  struct Verdict {
    std::string name, title, unit;
    Real value, error;  ///< infinite: unknown
    Real space, time;   ///< of the error: by the mesh, by steps
    Real asked;
    bool reached;
    /// `slip of "fault": 0.00321 m +- 2.1e-05 (0.65 %, asked 1 %), space 1.8e-05, time 3e-06`
    std::string line() const;
  };

  Adaptation() : bisection_(std::make_shared<std::optional<mesh::Bisection>>()) {}

  /// The scene whose model has the mesh and the steps as they are by now. At first steps are halved, on the mesh of the
  /// scene, until by that quantities change by less than 0.15 of the error that is asked for, or six times.
  void prepare(Scene& scene, RCP<const Comm> comm);

  /// Judges a run that has reached its end. A mesh is only trusted beside an earlier one: the estimate counts, or what
  /// the change of the value since then tells, if that is more.
  void judge(const Model& model, const Goals& goals);
  /// Whether there is to be another run; if not, why.
  bool goes_on() const { return why_.empty(); }
  const std::string& why() const { return why_; }
  bool reached() const;
  bool is_first() const { return runs_.empty(); }
  const std::vector<Verdict>& verdicts() const { return verdicts_; }
  /// What results.json has of it. Stored data.
  nlohmann::json summary() const;

  /// Halves the cells that matter most, as judge() has found them, once the model is not needed any more.
  void refine(const Comm& comm);

 private:
  /// What a run gave.
  struct Run {
    GlobalIndex cells;
    Real seconds;  ///< since the first began
    std::map<std::string, Goals::Estimate> estimates;
  };

  void choose_steps(Scene scene, RCP<const Comm> comm);
  Real space_error(const std::string& name) const;
  std::vector<GlobalIndex> cells_to_halve(const Model& model, const Goals& goals) const;
  std::string limit(const Accuracy& accuracy, const Comm& comm) const;

  std::shared_ptr<std::optional<mesh::Bisection>> bisection_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::optional<Time> time_;                 // that was chosen
  std::map<std::string, Real> time_errors_;  // by quantity; empty: a step failed
  std::vector<Run> runs_;
  std::vector<Verdict> verdicts_;
  std::vector<GlobalIndex> cells_;  // to be halved, of all ranks
  int dim_ = 0, order_ = 0;         // of the mesh
  std::string why_;
};

}  // namespace sprekk::model
