#include "model/growth_energies.hpp"

#include <algorithm>

namespace sprekk::model {

GrowthEnergies::GrowthEnergies(const mesh::Mesh& mesh, const std::vector<nlohmann::json>& journal)
    : sums_(mesh.single_fractures.size()) {
  for (const auto& entry : journal)
    if (const auto& step = entry.at("step"); step.contains("growth")) {
      const auto& growth = step.at("growth");
      for (std::size_t k = 0; k < growth.at("fracture").size(); ++k)
        add(growth.at("fracture")[k], growth.at("fracture_energy")[k], growth.at("lost_energy")[k]);
    }
}

void GrowthEnergies::add(const estimate::StateTable& extensions) {
  const auto values = [&](const char* name) {
    const auto found = std::find_if(extensions.columns.begin(), extensions.columns.end(),
                                    [&](const auto& column) { return column.name == name; });
    return found->values;
  };
  if (extensions.fractures.empty()) return;
  const auto dissipated = values("fracture_energy"), lost = values("lost_energy");
  for (std::size_t k = 0; k < lost.size(); ++k) add(extensions.fractures[k], dissipated[k], lost[k]);
}

void GrowthEnergies::add(std::size_t fracture, Real dissipated, Real lost) {
  sums_[fracture][0] += dissipated;
  sums_[fracture][1] += lost;
}

void GrowthEnergies::append(const mesh::Mesh& mesh, Grouping grouping, std::vector<FractureColumn>& columns) const {
  const bool by_sets = grouping == Grouping::sets;
  for (const int e : {0, 1}) {
    std::vector<Real> sums(by_sets ? mesh.fracture_names.size() : sums_.size(), 0);
    for (std::size_t k = 0; k < sums_.size(); ++k) sums[by_sets ? mesh.single_fractures[k].set : k] += sums_[k][e];
    const auto* name = e == 0 ? "fracture_energy" : "lost_energy";
    const auto known =
        std::find_if(columns.begin(), columns.end(), [&](const auto& column) { return column.name == name; });
    if (known == columns.end())
      columns.push_back({name, "", "J/m", 1, sums});
    else
      for (std::size_t k = 0; k < sums.size(); ++k) known->values[k] += sums[k];
  }
}

}  // namespace sprekk::model
