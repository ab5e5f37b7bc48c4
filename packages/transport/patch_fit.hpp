// Recovery of gradients from values at entity centres, with patches of entities around corners.
#pragma once

#include "transport/places.hpp"

namespace sprekk::transport {

/// Entity and its corners. A corner has the same number in all its entities, on all ranks.
template <int n_corners>
struct PatchEntity {
  std::array<Real, 3> centre = {};
  std::array<GlobalIndex, n_corners> corner = {};
  std::array<std::array<Real, 3>, n_corners> at = {};  ///< coordinates of the corners
  std::array<bool, n_corners> is_regular = {};         ///< values are smooth around the corner
};

/// Recovers gradients by least squares. A linear function is fitted around each corner to the values of the adjacent
/// entities. The gradient of an entity is the mean over its corners. Corners that are not regular or have fewer than
/// `fewest` entities count only if the entity has no others.
template <int n_corners>
class PatchFit {
 public:
  using Entity = PatchEntity<n_corners>;
  using Vector = std::array<Real, 3>;

  /// Builds the patches. Collective.
  PatchFit(std::vector<Entity> entities, int fewest, const RCP<const Comm>& comm)
      : entities_(std::move(entities)), fewest_(fewest) {
    for (const auto& entity : entities_) {
      auto& place = place_.emplace_back();
      for (int k = 0; k < n_corners; ++k) place[k] = places_.add(entity.corner[k]);
    }
    places_.close(comm);
  }

  /// Gradients [entity] of values [entity]. Collective.
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
  static constexpr Real ridge = 1e-3;  // relative to the mean spread: no gradient normal to coplanar centres
  using Sums = std::array<Real, 14>;   // sums of 1, x, the six x_i x_j, v, v x; x relative to the corner

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

  /// Computes C^-1 times the sum of v x, both about the means. C is the sum of x x^T plus the ridge term.
  static Vector gradient(const Sums& sums) {
    Real C[3][3], product[3];
    for (int i = 0, next = 4; i < 3; ++i) {
      product[i] = sums[11 + i] - sums[10] * sums[1 + i] / sums[0];
      for (int j = i; j < 3; ++j) C[i][j] = C[j][i] = sums[next++] - sums[1 + i] * sums[1 + j] / sums[0];
    }
    const Real added = ridge * (C[0][0] + C[1][1] + C[2][2]) / 3;
    if (added == 0) return {};  // single entity
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

}  // namespace sprekk::transport
