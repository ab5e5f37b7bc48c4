// The constant of the face law, held against the stiffness of the rock.
#include "assembly/system.hpp"

#include <Teuchos_CommHelpers.hpp>

#include <array>
#include <cmath>
#include <utility>

namespace sprekk::assembly {

using fields::BlockVector;

namespace {

constexpr Real usual = 3;  ///< stiffness of the rock, measured as below, over the constant
constexpr Real near = 10;  ///< factor within which the constant is left alone
enum Sum { worked, of_constant, moved, loaded, area, n_sums };

bool is_open(const Grip& grip) { return grip.held == std::array<mesh::Vector, 3>{}; }

}  // namespace

/// The rock answers a change of traction by a change of jump. From one balanced iterate to the next its stiffness is
///   - sum |f| dlambda . dw / sum |f| |dw|^2
/// over faces that stay closed, weighted by how far each deformation has moved. Measured once: stiffness does not
/// change, but between later iterates pieces that part move far, which says nothing of it.
bool System::calibrate(const BlockVector& x, bool first) {
  if (mesh_->n_global_fracture_faces == 0 || calibration_ != 0) return false;
  refresh_ghosts(x, false);
  const auto before = std::exchange(grips_, grips());
  if (first) return false;
  std::array<Real, n_sums> here{}, sums{};
  for (std::size_t f = 0; f < grips_.size(); ++f) {
    const auto& now = grips_[f];
    const Real size = mesh_->fracture_faces[f].area;
    here[area] += size;
    if (is_open(now) || is_open(before[f])) continue;
    for (int i = 0; i < 3; ++i) {
      const Real jump = now.jump[i] - before[f].jump[i];
      const Real traction = now.traction[i] - before[f].traction[i];
      here[worked] -= size * traction * jump;
      here[of_constant] += size * now.augmentation * jump * jump;
      here[moved] += size * jump * jump;
      here[loaded] += size * traction * traction;
    }
  }
  Teuchos::reduceAll(*comm(), Teuchos::REDUCE_SUM, static_cast<int>(n_sums), here.data(), sums.data());
  const Real noticeable = 1e-4 * scales_.length;  // without friction no work is done on closed faces
  if (!(sums[moved] > noticeable * noticeable * sums[area]) ||
      !(sums[worked] > 1e-2 * std::sqrt(sums[moved] * sums[loaded])))
    return false;
  const Real ratio = sums[worked] / sums[of_constant] / usual;
  const bool stays = ratio > 1 / near && ratio < near;
  calibration_ = stays ? 1 : ratio;
  return !stays;
}

}  // namespace sprekk::assembly
