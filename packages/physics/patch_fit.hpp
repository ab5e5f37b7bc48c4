// Gradients of values that entities have at their centres, from all entities around their corners.
#pragma once

#include "physics/places.hpp"

#include <cmath>

namespace sprekk::physics {

/// An entity and its corners; entities of one corner have one number of it, on all ranks.
template <int n_corners>
struct PatchEntity {
  std::array<Real, 3> centre = {};
  std::array<GlobalIndex, n_corners> corner = {};
  std::array<std::array<Real, 3>, n_corners> at = {};  ///< places of the corners
  std::array<bool, n_corners> is_regular = {};         ///< values are smooth around the corner
};

/// Around every corner a linear function is fitted by least squares to the values of the entities that meet there; the
/// gradient in an entity is the mean of those of its corners, of corners with too few entities around them only where
/// there are no others.
template <int n_corners>
class PatchFit {
 public:
  using Entity = PatchEntity<n_corners>;
  using Vector = std::array<Real, 3>;

  /// Collective.
  PatchFit(std::vector<Entity> entities, int fewest, const RCP<const Comm>& comm)
      : entities_(std::move(entities)), fewest_(fewest) {
    for (const auto& entity : entities_) {
      auto& place = place_.emplace_back();
      for (int k = 0; k < n_corners; ++k) place[k] = places_.add(entity.corner[k]);
    }
    places_.close(comm);
  }

  /// [entity] of values [entity]. Collective.
  std::vector<Vector> gradients(const std::vector<Real>& values) const {
    std::vector<Sums> sums(places_.size());
    for (std::size_t e = 0; e < entities_.size(); ++e)
      for (int k = 0; k < n_corners; ++k) add(entities_[e], k, values[e], sums[place_[e][k]]);
    places_.sum_over_ranks(sums);
    std::vector<Vector> at_corners, result;
    for (const auto& sum : sums) at_corners.push_back(gradient(sum));
    for (std::size_t e = 0; e < entities_.size(); ++e) {
      const auto counts = [&](int k) { return entities_[e].is_regular[k] && sums[place_[e][k]][0] >= fewest_; };
      int n = 0;
      for (int k = 0; k < n_corners; ++k) n += counts(k);
      Vector mean{};
      for (int k = 0; k < n_corners; ++k)
        for (int i = 0; i < 3 && (n == 0 || counts(k)); ++i)
          mean[i] += at_corners[place_[e][k]][i] / (n == 0 ? n_corners : n);
      result.push_back(mean);
    }
    return result;
  }

 private:
  static constexpr Real ridge = 1e-3;  // of the mean spread: no gradient where the entities lie in a plane or a line
  using Sums = std::array<Real, 14>;   // of 1, x, the six x_i x_j, v, v x, with x seen from the corner

  static void add(const Entity& entity, int k, Real value, Sums& sums) {
    Vector x;
    for (int i = 0; i < 3; ++i) x[i] = entity.centre[i] - entity.at[k][i];
    sums[0] += 1;
    sums[10] += value;
    for (int i = 0, next = 4; i < 3; ++i) {
      sums[1 + i] += x[i];
      sums[11 + i] += value * x[i];
      for (int j = i; j < 3; ++j) sums[next++] += x[i] * x[j];
    }
  }

  /// C^-1 times the sum of v x, both about the means, C the sum of x x^T and the ridge.
  static Vector gradient(const Sums& sums) {
    Real C[3][3], product[3];
    for (int i = 0, next = 4; i < 3; ++i) {
      product[i] = sums[11 + i] - sums[10] * sums[1 + i] / sums[0];
      for (int j = i; j < 3; ++j) C[i][j] = C[j][i] = sums[next++] - sums[1 + i] * sums[1 + j] / sums[0];
    }
    const Real added = ridge * (C[0][0] + C[1][1] + C[2][2]) / 3;
    if (added == 0) return {};  // of a single entity
    for (int i = 0; i < 3; ++i) C[i][i] += added;
    Vector result{};
    Real det = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
        const Real cofactor = C[a][c] * C[b][d] - C[a][d] * C[b][c];
        result[i] += cofactor * product[j];
        if (i == 0) det += C[0][j] * cofactor;
      }
    for (Real& component : result) component /= det;
    return result;
  }

  std::vector<Entity> entities_;
  int fewest_;
  Places places_;
  std::vector<std::array<int, n_corners>> place_;
};

}  // namespace sprekk::physics
