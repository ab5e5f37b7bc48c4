// Energies of growing fractures over time.
#pragma once

#include "estimate/state_table.hpp"
#include "model/fracture_table.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <vector>

namespace sprekk::model {

/// Sums of `fracture_energy` and `lost_energy` of the extensions of each single fracture since the start, J/m.
class GrowthEnergies {
 public:
  /// Continues after the steps of earlier runs, with entries as in Results::journal().
  GrowthEnergies(const mesh::Mesh& mesh, const std::vector<nlohmann::json>& journal);

  /// Adds the extensions of a step, a table as in Tips::extensions().
  void add(const estimate::StateTable& extensions);
  /// Adds the sums to the columns of the groups. An existing column gets the sum of both.
  void append(const mesh::Mesh& mesh, Grouping grouping, std::vector<FractureColumn>& columns) const;

 private:
  void add(std::size_t fracture, Real dissipated, Real lost);

  std::vector<std::array<Real, 2>> sums_;  ///< [single fracture] fracture energy, lost energy
};

}  // namespace sprekk::model
