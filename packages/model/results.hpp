// What a run leaves behind: results.json, the effective input, and pictures for ParaView.
#pragma once

#include "base/log.hpp"
#include "io/vtu.hpp"
#include "model/goals.hpp"
#include "model/error_estimate.hpp"
#include "model/probes.hpp"
#include "model/steps.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <chrono>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace sprekk::model {

/// The results of the runs that a run goes on from.
struct EarlierResults {
  std::vector<nlohmann::json> journal;                ///< what Results::journal() gave for all their steps
  nlohmann::json restarts = nlohmann::json::array();  ///< the times at which they went on
  nlohmann::json probes = nlohmann::json::object();   ///< Results::probes_begun()
  nlohmann::json stages = nlohmann::json::array();    ///< Results::stages()
};

/// Writes a model's states into a directory, step by step. Everything in it is complete after every write. All members
/// are collective; Errors name the path, on every rank.
class Results {
 public:
  /// The steps of `earlier` stay, and those that were written after them go.
  Results(Model& model, Scene as_read, std::string directory, const std::optional<EarlierResults>& earlier = {});

  /// The steps from number `begin` on, each with whether its fields were written and what probes saw; none on other
  /// ranks than 0. Stored data.
  std::vector<nlohmann::json> journal(int begin) const;
  /// Of each probe by its name: `definition`, and the `first` row of its table.
  const nlohmann::json& probes_begun() const { return probes_begun_; }
  nlohmann::json restarts() const { return json_.value("restarts", nlohmann::json::array()); }
  /// Those that have begun, with the mesh that each has.
  nlohmann::json stages() const { return json_.value("stages", nlohmann::json::array()); }
  int n_steps() const { return n_steps_; }

  /// Adds the state that the step ended with; `last` writes the files of fields whatever "every" says. Returns how many
  /// fracture faces are open, stick and slip.
  std::array<long long, 3> add_step(const StepTaken& taken, bool last);
  /// What may be wrong with the states added since the last call, each text once in the life of the results.
  std::vector<std::string> take_warnings() { return std::exchange(warnings_, {}); }
  /// Which single fractures are in which state after the last step, a line for each state. Stored data.
  std::vector<std::string> fracture_digest() const;
  /// How far quantities of the last state may be from exact ones, relative, by their names.
  const std::map<std::string, Real>& error_bounds() const { return error_bounds_; }
  /// The quantities of the section Accuracy in the states so far; of a scene that has one.
  const Goals& goals() const { return *goals_; }
  /// What `finish` is to tell of them.
  void add_accuracy(const nlohmann::json& summary) { json_["accuracy"] = summary; }
  /// "completed", "interrupted" or "failed", with the reason of a failure. Error: the results cannot be written; as far
  /// as the file of the last write has room for it, it says so.
  void finish(const std::string& status, const std::string& reason = "");

 private:
  nlohmann::json reactions();
  void add_fractures(nlohmann::json& step, const std::vector<assembly::OutputField>& outputs);
  void add(const nlohmann::json& step);
  void begin_stage(const std::string& name, Real time);
  void start_probes(const std::optional<EarlierResults>& earlier);
  void add_probes(const nlohmann::json& step, const std::vector<assembly::OutputField>& outputs);
  void add_error_bounds(const nlohmann::json& fractures, const std::vector<assembly::OutputField>& outputs);
  void start_fractures(const std::vector<Real>& written);  ///< their pictures go on after the steps at these times
  long long add_unsettled(const solve::StepReport& report);
  bool fields_are_due(const StepTaken& step) const;
  void write_fields(Real time, const std::vector<assembly::OutputField>& outputs);
  void write_json();
  void finish_in_place(const std::string& reason);

  Model& model_;
  std::string directory_;
  std::optional<ErrorEstimator> estimator_;
  std::optional<Goals> goals_;
  std::optional<io::VtuSeries> bulk_, fractures_;
  Probes probes_;
  std::optional<io::SeriesFiles> series_;       // of probes
  std::vector<FractureColumn> sets_, singles_;  // of the last step
  std::map<std::string, std::string> units_;    // of what reactions() gives
  nlohmann::json json_, probes_begun_ = nlohmann::json::object();
  int n_steps_ = 0, n_written_ = 0;
  std::vector<Real> ends_;  // of the steps so far, after the start
  std::set<std::string> told_;
  std::vector<std::string> warnings_;
  std::map<std::string, Real> error_bounds_;
  std::chrono::steady_clock::time_point last_write_;
  std::chrono::steady_clock::duration write_took_{};
};

/// Leaves a results.json that says why a run never began, or with `only_replace` only in place of one that is there;
/// silent if it cannot be written. Collective.
void write_failure(const Comm& comm, const std::string& directory, const std::string& reason, bool only_replace);

/// Fields, blocks with their unknowns and bytes, and what is exchanged between ranks. Collective.
nlohmann::json block_summary(const assembly::System& system);

}  // namespace sprekk::model
