// Stress around crack tips: singular crack modes.
#pragma once

#include "base/symmetric.hpp"
#include "fields/properties.hpp"
#include "laws/elasticity.hpp"
#include "mesh/tip_frames.hpp"

#include <array>
#include <complex>
#include <optional>

namespace sprekk::physics {

/// Stresses of a crack in plane strain at the local crack tips (Williams 1957), in terms of Westergaard's functions
/// Z = z^(-1/2), at order 2 also z^(1/2), with z = x1 + i x2. x1 points ahead of the crack, x2 along its normal, x3
/// along its front: mesh::TipFrames.
///   opening: s11 = Re Z - x2 Im Z', s22 = Re Z + x2 Im Z', s12 = -x2 Re Z'
///   sliding: s11 = 2 Im Z + x2 Re Z', s22 = -x2 Re Z', s12 = Re Z - x2 Im Z'     s33 = nu (s11 + s22)
///   tearing, in 3D: s13 = Im Z, s23 = Re Z
template <int dim, int order>
class TipModes {
 public:
  static constexpr int n = order * dim;
  using Tensor = base::Symmetric<dim>;
  using Values = typename Tensor::Values;

  TipModes(const mesh::Mesh& mesh, const fields::Properties<laws::Elasticity>& elasticity)
      : mesh_(mesh), elasticity_(elasticity), frames_(mesh) {}

  /// Modes around a tip at a point of a local cell with this tip as a corner, Pa m^0.5. None if TipFrames has no axes.
  std::optional<std::array<Values, n>> at(LocalIndex cell, LocalIndex tip, const std::array<Real, dim>& x) const {
    std::array<mesh::Vector, 3> axes{};
    if (!frames_.find(cell, tip, axes)) return std::nullopt;
    mesh::Vector from{};
    for (int i = 0; i < dim; ++i) from[i] = x[i] - mesh_.coordinates[tip * dim + i];
    const auto& rock = elasticity_.of_cell(mesh_, cell);
    return turned(axes, mesh::dot(from, axes[0]), mesh::dot(from, axes[1]), rock.lambda / (2 * (rock.lambda + rock.G)));
  }

 private:
  /// Modes at (x1, x2) in global components; the rows of `axes` are the local axes.
  static std::array<Values, n> turned(const std::array<mesh::Vector, 3>& axes, Real x1, Real x2, Real poisson) {
    const std::complex<Real> z(x1, x2), root = std::sqrt(z);
    std::array<std::array<std::array<Real, 3>, 3>, 3 * order> local{};
    for (int k = 0; k < order; ++k) {
      const std::complex<Real> Z = k == 0 ? Real(1) / root : root, slope = (k - Real(0.5)) * Z / z;
      const auto plane = [&](int mode, Real s11, Real s22, Real s12) {
        local[dim * k + mode] = {{{s11, s12, 0}, {s12, s22, 0}, {0, 0, poisson * (s11 + s22)}}};
      };
      plane(0, Z.real() - x2 * slope.imag(), Z.real() + x2 * slope.imag(), -x2 * slope.real());
      plane(1, 2 * Z.imag() + x2 * slope.real(), -x2 * slope.real(), Z.real() - x2 * slope.imag());
      if (dim == 3) local[dim * k + 2] = {{{0, 0, Z.imag()}, {0, 0, Z.real()}, {Z.imag(), Z.real(), 0}}};
    }
    std::array<Values, n> modes{};
    for (int m = 0; m < n; ++m)
      for (int c = 0; c < Tensor::n; ++c)
        for (int k = 0; k < dim; ++k)
          for (int l = 0; l < dim; ++l)
            modes[m][c] += axes[k][Tensor::row(c)] * local[m][k][l] * axes[l][Tensor::column(c)];
    return modes;
  }

  const mesh::Mesh& mesh_;
  const fields::Properties<laws::Elasticity>& elasticity_;
  mesh::TipFrames frames_;
};

}  // namespace sprekk::physics
