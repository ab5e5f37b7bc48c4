#include "mesh/flat_cells.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "mesh/facets.hpp"
#include "mesh/union_find.hpp"

namespace sprekk::mesh {
namespace {

constexpr Real largest_ratio = 0.1;
constexpr std::size_t max_squares_per_facet = 10;  // a matrix has 5 to 11 entries per facet

using Sets = std::vector<std::vector<LocalIndex>>;

/// Cells with ratios, joined by their facets.
class FlatCells {
 public:
  FlatCells(const Mesh& mesh, std::size_t max_size) : mesh_(mesh), max_size_(max_size) {
    for (LocalIndex cell = 0; cell < mesh.n_cells(); ++cell)
      if (const Real ratio = radius_ratio(mesh, cell); ratio < largest_ratio) {
        cells_.push_back(cell);
        ratios_[cell] = ratio;
      }
  }

  Sets facets_below(Real bound) const {
    Sets found;
    add(cells_, bound, found);
    return found;
  }

 private:
  /// Adds the sets of those cells whose ratio is below the bound. Halves the bound within large sets.
  void add(const std::vector<LocalIndex>& among, Real bound, Sets& found) const {
    std::map<LocalIndex, GlobalIndex> first;  // by facet: number of the first of these cells
    std::vector<LocalIndex> cells;
    std::copy_if(among.begin(), among.end(), std::back_inserter(cells),
                 [&](LocalIndex cell) { return ratios_.at(cell) < bound; });
    UnionFind joined(static_cast<GlobalIndex>(cells.size()));
    for (std::size_t i = 0; i < cells.size(); ++i)
      for_facets(cells[i], [&](LocalIndex facet) {
        joined.join(static_cast<GlobalIndex>(i), first.try_emplace(facet, static_cast<GlobalIndex>(i)).first->second);
      });
    std::map<GlobalIndex, std::vector<LocalIndex>> of_set;
    for (std::size_t i = 0; i < cells.size(); ++i) of_set[joined.find(static_cast<GlobalIndex>(i))].push_back(cells[i]);
    for (const auto& [set, its_cells] : of_set) {
      auto facets = owned_facets(its_cells);
      if (facets.size() > max_size_)
        add(its_cells, bound / 2, found);
      else if (!facets.empty())
        found.push_back(std::move(facets));
    }
  }

  std::vector<LocalIndex> owned_facets(const std::vector<LocalIndex>& cells) const {
    std::vector<LocalIndex> facets;
    for (const LocalIndex cell : cells)
      for_facets(cell, [&](LocalIndex facet) {
        if (facet < mesh_.facets->n_owned) facets.push_back(facet);
      });
    std::sort(facets.begin(), facets.end());
    facets.erase(std::unique(facets.begin(), facets.end()), facets.end());
    return facets;
  }

  template <class Visit>
  void for_facets(LocalIndex cell, const Visit& visit) const {
    const int n = n_faces(mesh_.shape);
    for (int k = 0; k < n; ++k) visit(mesh_.facets->of_cell[cell * n + k]);
  }

  const Mesh& mesh_;
  std::size_t max_size_;
  std::vector<LocalIndex> cells_;
  std::map<LocalIndex, Real> ratios_;
};

std::size_t sum_of_squares(const Sets& sets) {
  std::size_t sum = 0;
  for (const auto& set : sets) sum += set.size() * set.size();
  return sum;
}

}  // namespace

Real radius_ratio(const Mesh& mesh, LocalIndex cell) {
  if (!is_simplex(mesh.shape)) return 1;
  const int dim = mesh.dim();
  std::array<Vector, 4> x{};
  for (int k = 0; k <= dim; ++k)
    std::copy_n(&mesh.coordinates[mesh.cells[cell * mesh.nodes_per_cell() + k] * dim], dim, x[k].begin());
  const auto length = [&](int a, int b) { return norm(x[b] - x[a]); };
  const auto area = [&](int a, int b, int c) { return norm(cross(x[b] - x[a], x[c] - x[a])) / 2; };
  if (dim == 2) {
    const Real a = length(0, 1), b = length(1, 2), c = length(2, 0), size = area(0, 1, 2);
    const Real below = (a + b + c) * a * b * c;
    return below > 0 ? 16 * size * size / below : 0;
  }
  const Real volume = std::abs(dot(x[1] - x[0], cross(x[2] - x[0], x[3] - x[0]))) / 6;
  const Real p = length(0, 1) * length(2, 3), q = length(0, 2) * length(1, 3), r = length(0, 3) * length(1, 2);
  const Real radius = std::sqrt(std::max(0.0, (p + q + r) * (p + q - r) * (p - q + r) * (q + r - p)));  // R 24 V
  const Real below = (area(0, 1, 2) + area(0, 1, 3) + area(0, 2, 3) + area(1, 2, 3)) * radius;
  return below > 0 ? 216 * volume * volume / below : 0;
}

Sets facets_of_flat_cells(const Mesh& mesh, std::size_t max_size) {
  if (!is_simplex(mesh.shape) || !mesh.facets->in_rock) return {};
  const FlatCells cells(mesh, max_size);
  for (Real bound = largest_ratio;; bound /= 2) {
    auto sets = cells.facets_below(bound);
    if (sum_of_squares(sets) <= max_squares_per_facet * static_cast<std::size_t>(mesh.facets->n_owned)) return sets;
  }
}

}  // namespace sprekk::mesh
