// What a run looks at in every step: the section Probes of a scene.
#pragma once

#include "io/series.hpp"
#include "model/fracture_table.hpp"
#include "model/model.hpp"
#include "model/probe_places.hpp"

#include <functional>
#include <map>

namespace sprekk::model {

/// What is known of a state.
struct Observation {
  const std::vector<assembly::OutputField>& outputs;
  const std::vector<FractureColumn>& sets;          ///< numbers of sets of fractures
  const std::vector<FractureColumn>& singles;       ///< of single fractures
  const nlohmann::json& sums;                       ///< by names, as in results.json: `reactions > east`
  const std::map<std::string, std::string>& units;  ///< of sums by the first of their names, or by all: `a > b > c`
};

/// The probes of a model's scene as tables.
class Probes {
 public:
  /// Finds the places and the outputs. Error: a line for each that is not there, naming the probe, what it asks for and
  /// what there is. A place that is excavated has no values. Collective.
  explicit Probes(const Model& model);

  /// Looks at the changed mesh of the model from now on. Collective.
  void look_again();

  bool empty() const { return tables_.empty(); }
  /// What each table tells of a state, [table][place * columns + column], the same on every rank. Collective.
  std::vector<std::vector<Real>> values(const Observation& observation);
  /// Without rows; complete after the first values().
  const std::vector<io::SeriesTable>& tables() const { return tables_; }
  /// What the scene says of each, [table].
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
  std::vector<io::SeriesTable> tables_;
  std::vector<std::vector<Look>> looks_;  ///< [table]
};

}  // namespace sprekk::model
