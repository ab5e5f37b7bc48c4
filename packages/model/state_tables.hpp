// Tables of quantities at points of fractures, in results.json and as CSV files.
#pragma once

#include "estimate/state_table.hpp"
#include "model/model.hpp"

#include <nlohmann/json.hpp>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace sprekk::model {

/// Tables that the scene of a model requests. Refers to the model. Construction is collective.
class StateTables {
 public:
  explicit StateTables(Model& model);

  /// Returns the entries of the present state for a step of results.json: by name of the table, one list per column.
  /// The column "fracture" contains numbers of single fractures. Collective.
  nlohmann::json of_state(const std::vector<assembly::OutputField>& outputs);
  /// Units of all columns of the tables so far, by name of the table. Stored data.
  const nlohmann::json& units() const { return units_; }

 private:
  Model& model_;
  std::map<std::string, std::unique_ptr<estimate::TableOfStates>> tables_;
  nlohmann::json units_ = nlohmann::json::object();
};

/// Returns the names of all tables that a scene can request, as in results.json.
std::vector<std::string> names_of_tables();

/// Returns the tables in the steps of results.json as CSV texts, by name: one line per step and row, in the order of
/// the steps. Undefined numbers are empty cells. Not collective.
std::map<std::string, std::string> tables_csv(const nlohmann::json& results);

}  // namespace sprekk::model
