// Output of a run: results.json, the effective input, and files for ParaView.
#pragma once

#include "base/log.hpp"
#include "io/vtu.hpp"
#include "model/error_estimates.hpp"
#include "model/event_catalogue.hpp"
#include "model/growth_energies.hpp"
#include "model/probes.hpp"
#include "model/state_tables.hpp"
#include "model/steps.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <chrono>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace sprekk::model {

/// Results of previous runs that this run continues.
struct EarlierResults {
  std::vector<nlohmann::json> journal;                ///< Results::journal() for all their steps
  nlohmann::json restarts = nlohmann::json::array();  ///< times of the restarts, s
  nlohmann::json probes = nlohmann::json::object();   ///< Results::probes_begun()
  nlohmann::json stages = nlohmann::json::array();    ///< Results::stages()
  io::NamedVectors faces = {};                        ///< Results::faces()
  nlohmann::json common = nlohmann::json::object();   ///< Results::common_entries()
};

/// Writer of the states of a model into a directory, step by step. All files are complete after every write. All
/// members are collective; Errors name the path, on every rank.
class Results {
 public:
  /// Retains the steps of `earlier` and removes later ones.
  Results(Model& model, Scene as_read, std::string directory, const std::optional<EarlierResults>& earlier = {});

  /// Steps from number `begin` on, with their probe values and a mark for written fields; empty on ranks other than 0.
  /// Stored data.
  std::vector<nlohmann::json> journal(int begin) const;
  /// By name of the probe: `definition`, and the `first` row of its table.
  const nlohmann::json& probes_begun() const { return probes_begun_; }
  nlohmann::json restarts() const { return json_.value("restarts", nlohmann::json::array()); }
  /// Stages that have begun, with their meshes.
  nlohmann::json stages() const { return json_.value("stages", nlohmann::json::array()); }
  /// Entries about all steps, as far as there are any: units of quantities, and the initial state.
  nlohmann::json common_entries() const;
  int n_steps() const { return n_steps_; }
  /// Data of fracture faces in events that may continue, for a checkpoint.
  io::NamedVectors faces() const { return catalogue_ ? catalogue_->memory(model_.mesh()) : io::NamedVectors(); }

  /// Adds the state at the end of a step; `last` writes field files regardless of "every". Returns the numbers of open,
  /// sticking and slipping fracture faces.
  std::array<long long, 3> add_step(const StepTaken& taken, bool last);
  /// Value of a column of the log after the last step; NaN if undefined. Stored data of rank 0.
  Real value_of(const physics::LogColumn& column) const;
  /// Returns warnings for the states added since the last call; each text occurs only once.
  std::vector<std::string> take_warnings() { return std::exchange(warnings_, {}); }
  /// Lines with the single fractures in each contact state after the last step. Stored data.
  std::vector<std::string> fracture_digest() const;
  /// Relative error bounds of quantities in the last state, by their names.
  const std::map<std::string, Real>& error_bounds() const { return error_bounds_; }
  /// Quantities of the section Accuracy in the states so far. The scene must have this section.
  const estimate::Goals& goals() const { return *estimates_->goals(); }
  /// Estimates on the present mesh of the model. The scene must have the section Accuracy.
  RunEstimates& estimates();
  /// Sets the entry "accuracy" for finish().
  void add_accuracy(const nlohmann::json& summary) { json_["accuracy"] = summary; }
  /// Finishes the results with the status "completed", "interrupted" or "failed", with the reason of a failure. Throws
  /// an Error if writing fails; if possible, the last file then contains the reason.
  void finish(const std::string& status, const std::string& reason = "");

 private:
  nlohmann::json reactions();
  void add_fractures(nlohmann::json& step, const std::vector<assembly::OutputField>& outputs);
  void add_growth(nlohmann::json& step, const estimate::StateTable& extensions);
  void add(const nlohmann::json& step);
  void follow_change();
  void begin_stage(const std::string& name, Real time);
  void add_initial_state();
  void start_probes(const std::optional<EarlierResults>& earlier);
  void add_probes(const nlohmann::json& step, const std::vector<assembly::OutputField>& outputs);
  void add_error_bounds(const nlohmann::json& fractures, const std::vector<assembly::OutputField>& outputs);
  void start_fractures(const std::vector<Real>& written);  ///< continues their files after the steps at these times
  void add_intersections();
  long long add_oscillating(const solve::StepReport& report);
  bool fields_are_due(const StepTaken& step) const;
  void write_fields(Real time, const std::vector<assembly::OutputField>& outputs);
  void remove_earlier(bool goes_on) const;
  void write_json();
  void finish_in_place(const std::string& reason);

  Model& model_;
  std::string directory_;
  std::optional<RunEstimates> estimates_;
  std::optional<io::VtuSeries> bulk_, fractures_;
  Probes probes_;
  int n_changes_;  // changes of the model up to the last step
  std::optional<EventCatalogue> catalogue_;
  std::optional<StateTables> tables_;
  std::optional<GrowthEnergies> grown_;
  std::optional<io::SeriesFiles> series_;       // files of the probes
  std::vector<FractureColumn> sets_, singles_;  // of the last step
  std::map<std::string, std::string> units_;    // units of reactions()
  nlohmann::json json_, probes_begun_ = nlohmann::json::object();
  int n_steps_ = 0, n_written_ = 0;
  std::vector<Real> ends_;  // end times of the steps so far, s
  std::set<std::string> reported_;
  std::vector<std::string> warnings_;
  std::map<std::string, Real> error_bounds_;
  struct {
    std::chrono::steady_clock::time_point end;
    std::chrono::steady_clock::duration took{};
  } write_;  // last one of results.json
};

/// Writes a results.json with the reason why a run did not begin. With `only_replace`, it only replaces an existing
/// file. Failures to write are ignored. Collective.
void write_failure(const Comm& comm, const std::string& directory, const std::string& reason, bool only_replace);

/// Returns `mesh` with the numbers of entities, and `partition`. Stored data.
nlohmann::json mesh_summary(const mesh::Mesh& mesh);

/// Returns fields, blocks with their unknowns and bytes, and the exchange between ranks. Collective.
nlohmann::json block_summary(const assembly::System& system);

}  // namespace sprekk::model
