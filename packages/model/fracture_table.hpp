// Fracture averages, maxima and integrals over faces, and derived values.
#pragma once

#include "assembly/module.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::model {

/// Column with one number or vector per group of fracture faces.
struct FractureColumn {
  std::string name, frame, unit;  ///< frame: "global" or "local" for vectors, else empty
  int n_components = 1;
  std::vector<Real> values = {};  ///< [group * n_components + component]; NaN if undefined
  std::optional<assembly::Events> events = {};

  /// Number or vector of a group.
  nlohmann::json of(std::size_t group) const;
  /// Name followed by the frame.
  std::string full_name() const { return frame.empty() ? name : name + "_" + frame; }
};

/// Groups of faces: sets of fractures as listed in the scene, or single fractures.
enum class Grouping { sets, singles };

/// Computes the area and the summaries of the outputs for each group. The cost is linear in faces and groups.
/// Collective.
std::vector<FractureColumn> fracture_table(const mesh::Mesh& mesh, const std::vector<assembly::OutputField>& outputs,
                                           Grouping grouping);

/// Returns the columns of sets by their names, vectors by the names of their frames.
nlohmann::json by_sets(const mesh::Mesh& mesh, const std::vector<FractureColumn>& columns);
/// Returns one list per column name. Vectors are in the local frame only.
nlohmann::json by_singles(const std::vector<FractureColumn>& columns);
/// Units of the columns returned by by_singles().
nlohmann::json units(const std::vector<FractureColumn>& columns);

/// Returns the numbers of faces in each of three states, of outputs with three classes: open, sticking and slipping
/// faces. Collective.
std::array<long long, 3> counts_of_classes(const Comm& comm, const std::vector<assembly::OutputField>& outputs);

/// Returns for each single fracture its name, set, area, centre, mean normal, strike and, in 3D, dip; angles in
/// degrees. Collective.
nlohmann::json described_singles(const mesh::Mesh& mesh);

/// Returns the numbers of a list in results.json; null becomes NaN.
std::vector<Real> values_of(const nlohmann::json& list);
/// Returns a text as a cell of a CSV table, with quotation marks if necessary.
std::string csv_cell(std::string text);

/// Writes the table of single fractures as CSV text: one line per fracture, with the entries of described_singles() and
/// the columns. Column titles contain units; areas in 2D have the title `length`. Values below 1e-14 of the largest of
/// their column are written as 0.
std::string to_csv(const nlohmann::json& described, const std::vector<FractureColumn>& columns);

/// Returns one line per class of faces, `open on 2 of 12 fractures: "a" (100 % of its area), "b" (35 %)`. Fractures are
/// ordered by their share of the area in this state, largest first.
std::vector<std::string> digest(const nlohmann::json& described, const std::vector<FractureColumn>& columns);

}  // namespace sprekk::model
