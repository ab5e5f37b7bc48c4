// Gradients from what entities know of a linear function, from all entities around their corners.
#pragma once

#include "physics/places.hpp"

#include <cmath>

namespace sprekk::physics {

/// Entities with corners; those of one corner have one number of it, on all ranks.
template <int n_corners>
struct PatchEntity {
  std::array<GlobalIndex, n_corners> corner;
  std::array<std::array<Real, 3>, n_corners> at = {};  ///< places of the corners
  std::array<bool, n_corners> is_regular = {};         ///< the function is smooth around the corner
};

/// Around every corner a linear function of m components, v + G (x - corner), is fitted by least squares to equations
/// of the entities that meet there; the gradient of an entity is the mean of those of its corners, of corners with too
/// few entities around them only where there are no others.
template <int m, int n_corners>
class PatchFit {
 public:
  using Entity = PatchEntity<n_corners>;
  static constexpr int n_unknowns = 4 * m;
  using Row = std::array<Real, n_unknowns>;  ///< factors of v, then of G row by row
  using Gradient = std::array<std::array<Real, 3>, m>;

  /// Collective.
  PatchFit(std::vector<Entity> entities, int fewest, const RCP<const Comm>& comm)
      : entities_(std::move(entities)), fewest_(fewest) {
    for (const auto& entity : entities_) {
      auto& place = place_.emplace_back();
      for (int k = 0; k < n_corners; ++k) place[k] = places_.add(entity.corner[k]);
    }
    places_.close(comm);
  }

  /// A row whose product with v and G is `along` . (v + G x).
  static Row row(const std::array<Real, m>& along, const std::array<Real, 3>& x) {
    Row result;
    for (int i = 0; i < m; ++i) {
      result[i] = along[i];
      for (int j = 0; j < 3; ++j) result[m + 3 * i + j] = along[i] * x[j];
    }
    return result;
  }

  /// [entity] where equations(entity, k, add) calls add(row, value) for each, with x seen from corner k. Collective.
  template <class Equations>
  std::vector<Gradient> gradients(const Equations& equations) const {
    std::vector<Sums> sums(places_.size());
    for (std::size_t e = 0; e < entities_.size(); ++e)
      for (int k = 0; k < n_corners; ++k) {
        auto& sum = sums[place_[e][k]];
        sum[count] += 1;
        equations(static_cast<LocalIndex>(e), entities_[e].at[k],
                  [&](const Row& row, Real value) { add(row, value, sum); });
      }
    places_.sum_over_ranks(sums);
    std::vector<Gradient> at_corners;
    for (const auto& sum : sums) at_corners.push_back(solve(sum));
    std::vector<Gradient> result;
    for (std::size_t e = 0; e < entities_.size(); ++e) {
      const auto counts = [&](int k) { return entities_[e].is_regular[k] && sums[place_[e][k]][count] >= fewest_; };
      int n = 0;
      for (int k = 0; k < n_corners; ++k) n += counts(k);
      auto& mean = result.emplace_back();
      for (auto& of : mean) of = {};
      for (int k = 0; k < n_corners; ++k)
        for (int i = 0; i < m && (n == 0 || counts(k)); ++i)
          for (int j = 0; j < 3; ++j) mean[i][j] += at_corners[place_[e][k]][i][j] / (n == 0 ? n_corners : n);
    }
    return result;
  }

 private:
  static constexpr Real ridge = 1e-3;  // of the mean of squares: no gradient where equations say nothing of it
  static constexpr int n_products = n_unknowns * (n_unknowns + 1) / 2, count = n_products + n_unknowns;
  using Sums = std::array<Real, count + 1>;

  static void add(const Row& row, Real value, Sums& sums) {
    int next = 0;
    for (int i = 0; i < n_unknowns; ++i)
      for (int j = 0; j <= i; ++j) sums[next++] += row[i] * row[j];
    for (int i = 0; i < n_unknowns; ++i) sums[next++] += row[i] * value;
  }

  /// By Cholesky's factors.
  static Gradient solve(const Sums& sums) {
    Real L[n_unknowns][n_unknowns], x[n_unknowns], squares[2] = {};
    const auto is_gradient = [](int i) { return i >= m; };
    for (int i = 0, next = 0; i < n_unknowns; ++i)
      for (int j = 0; j <= i; ++j) L[i][j] = sums[next++];
    for (int i = 0; i < n_unknowns; ++i) squares[is_gradient(i)] += L[i][i] / (is_gradient(i) ? 3 * m : m);
    Gradient G{};
    if (squares[1] == 0) return G;
    for (int i = 0; i < n_unknowns; ++i) L[i][i] += ridge * squares[is_gradient(i)];
    for (int i = 0; i < n_unknowns; ++i) {
      for (int j = 0; j <= i; ++j) {
        for (int k = 0; k < j; ++k) L[i][j] -= L[i][k] * L[j][k];
        L[i][j] = i == j ? std::sqrt(L[i][i]) : L[i][j] / L[j][j];
      }
      x[i] = sums[n_products + i];
      for (int k = 0; k < i; ++k) x[i] -= L[i][k] * x[k];
      x[i] /= L[i][i];
    }
    for (int i = n_unknowns - 1; i >= 0; --i) {
      for (int k = i + 1; k < n_unknowns; ++k) x[i] -= L[k][i] * x[k];
      x[i] /= L[i][i];
    }
    for (int i = 0; i < m; ++i)
      for (int j = 0; j < 3; ++j) G[i][j] = x[m + 3 * i + j];
    return G;
  }

  std::vector<Entity> entities_;
  int fewest_;
  Places places_;
  std::vector<std::array<int, n_corners>> place_;
};

}  // namespace sprekk::physics
