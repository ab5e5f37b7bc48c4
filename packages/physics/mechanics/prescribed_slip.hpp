// Slip of fractures as a function of position and time.
#pragma once

#include "base/expression.hpp"
#include "base/parameters.hpp"
#include "mesh/mesh.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::physics {

/// Section "prescribed slip" of a fracture. The plastic tangential jump of its faces is
///   2D:                     slip[0], left-lateral in the plane x, y
///   3D:                     slip[0] left-lateral and slip[1] reverse, by strike and dip with z up
///   2D and 3D, `direction`: slip[0] along the projection of this vector on the face
/// The sides are those of Aki and Richards (1980): the hanging wall, above the upward normal, moves by slip[0] along
/// the strike and by slip[1] up the dip, relative to the foot wall. The strike has the dip on its right. On vertical
/// faces the side towards +y, or +x if n_y = 0, is the hanging wall. With `direction` the side at which `moving side`
/// points moves, relative to the other side.
struct PrescribedSlip {
  std::vector<base::Expression> slip;            ///< m, of x, y, z, t
  std::optional<base::Expression> opening;       ///< normal jump, m; absent: contact
  std::vector<Real> direction, moving_side;      ///< vectors; empty: strike and dip
  std::vector<Real> lower_corner, upper_corner;  ///< only faces with the centre in this box; empty: all faces
  void describe(base::Section& section);
  void check(base::Section& section) const;

  bool contains(const std::array<Real, 3>& centre) const;
  bool constant_in_time() const;
  /// Unit vectors for the components of `slip`, times the sign of the side +, for a face with the frame (n, t1[, t2]).
  /// Throws an Error for a horizontal face without `direction`, for a direction along n, and for a moving side in the
  /// plane of the face.
  std::vector<std::array<Real, 3>> axes(const std::array<std::array<Real, 3>, 3>& frame, int dim) const;
};

/// Prescribed jumps of all fractures, [name].
using PrescribedSlips = std::map<std::string, PrescribedSlip>;

/// Returns `given` of laws::prescribed_residual() for all owned faces at time t, [face, dim] m: face means of slip and
/// opening. Throws an Error that names fracture, entry and place.
std::vector<Real> prescribed_jumps(const PrescribedSlips& slips, const mesh::Mesh& mesh, Real t);

}  // namespace sprekk::physics
