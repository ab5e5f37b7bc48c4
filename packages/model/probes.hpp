// Section Probes of a scene: values recorded in every step.
#pragma once

#include "io/series.hpp"
#include "model/fracture_table.hpp"
#include "model/model.hpp"
#include "model/probe_places.hpp"

#include <functional>
#include <map>

namespace sprekk::model {

/// Data of one state.
struct Observation {
  const std::vector<assembly::OutputField>& outputs;
  const std::vector<FractureColumn>& sets;          ///< values of sets of fractures
  const std::vector<FractureColumn>& singles;       ///< values of single fractures
  const nlohmann::json& sums;                       ///< by names, as in results.json: `reactions > east`
  const std::map<std::string, std::string>& units;  ///< units of sums, by their first name or by all: `a > b > c`
};

/// Probes of a scene of a model, as tables.
class Probes {
 public:
  /// Finds the places and the outputs. Throws an Error with one line per missing item: the probe, the requested name,
  /// and the available names. Excavated places have no values. Collective.
  explicit Probes(const Model& model);

  /// Updates the probes after a change of the mesh of the model. Collective.
  void update_places();

  bool empty() const { return tables_.empty(); }
  /// Returns the values of each table for a state, [table][place * columns + column], the same on every rank.
  /// Collective.
  std::vector<std::vector<Real>> values(const Observation& observation);
  /// Tables without rows; complete after the first values().
  const std::vector<io::SeriesTable>& tables() const { return tables_; }
  /// Definitions of the probes in the scene, [table].
  std::vector<std::string> definitions() const;

 private:
  using Look = std::function<std::vector<Real>(const Observation&)>;  ///< [place * components + component]
  struct Known;

  void add(const std::string& name, const physics::Probe& probe, const Known& known);
  void add_output(const physics::Probe& probe, const assembly::OutputField& output);
  void add_number(bool is_set, int fracture, const FractureColumn& column);
  void add_sum(const std::string& output, const std::string& place, int n_components, const std::string& unit);
  void add_totals(const std::vector<std::string>& names);
  Look look(const physics::Probe& probe, const assembly::OutputField& output) const;

  const Model& model_;
  std::map<std::string, physics::Probe> probes_;  // of the scene at the begin; a change of the scene may lack them
  std::vector<io::SeriesTable> tables_;
  std::vector<std::vector<Look>> looks_;  ///< [table]
};

}  // namespace sprekk::model
