// Numbers of fractures: means, maxima, integrals over their faces, and what follows from those.
#pragma once

#include "assembly/module.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace sprekk::model {

/// One number, or one vector, of each group of fracture faces.
struct FractureColumn {
  std::string name, frame, unit;  ///< frame: of vectors, "global" or "local"; else empty
  int n_components = 1;
  std::vector<Real> values = {};  ///< [group * n_components + component]; NaN where it has no meaning

  /// The number or the vector of a group.
  nlohmann::json of(std::size_t group) const;
  /// With the frame behind it.
  std::string full_name() const { return frame.empty() ? name : name + "_" + frame; }
};

/// What faces are summed up to: sets of fractures, as a scene lists them, or single fractures.
enum class Grouping { sets, singles };

/// Area, and what the summaries of the outputs tell. Collective; linear in faces and groups.
std::vector<FractureColumn> fracture_table(const mesh::Mesh& mesh, const std::vector<assembly::OutputField>& outputs,
                                           Grouping grouping);

/// The columns of sets by their names, vectors by the names of their frames.
nlohmann::json by_sets(const mesh::Mesh& mesh, const std::vector<FractureColumn>& columns);
/// Lists by the names of columns, vectors in the local frame alone, without the area.
nlohmann::json by_singles(const std::vector<FractureColumn>& columns);
/// The units of what by_singles() gives.
nlohmann::json units(const std::vector<FractureColumn>& columns);

/// Of each single fracture its name, set, area, centre, mean normal, strike and, in 3D, dip, in degrees. Collective.
nlohmann::json described_singles(const mesh::Mesh& mesh);

/// A table of single fractures for people and other programs: a line each, as described_singles() and columns say, with
/// titles that have units.
std::string to_csv(const nlohmann::json& described, const std::vector<FractureColumn>& columns);

/// A line for each class of a state, `slip: 2 of 12 fractures: "a" (100 %), "b" (35 %)`, by the share of their area,
/// the largest first.
std::vector<std::string> digest(const nlohmann::json& described, const std::vector<FractureColumn>& columns);

}  // namespace sprekk::model
