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

bool is_open(const Grip& grip) { return grip.held == std::array<mesh::Vector, 3>{}; }

}  // namespace

/// The rock answers a change of traction by a change of jump. From one balanced iterate to the next its stiffness is
///   - sum |f| dlambda . dw / sum |f| |dw|^2
/// over faces that stay closed, weighted by how far each deformation has moved. Measured once: stiffness does not
/// change, but between later iterates pieces that part move far, which says nothing of it. One factor for all faces
/// means nothing where rocks differ: there the constant stays.
bool System::calibrate(const BlockVector& x, bool first) {
  if (calibrated_ || mesh_->n_global_fracture_faces == 0 || (loose_ && loose_->contrast() > near)) return false;
  refresh_ghosts(x, false);
  const auto before = std::exchange(grips_, grips());
  if (first) return false;
  std::array<Real, 4> here{}, all{};
  for (std::size_t f = 0; f < grips_.size(); ++f) {
    const auto& now = grips_[f];
    if (is_open(now) || is_open(before[f])) continue;
    const Real area = mesh_->fracture_faces[f].area;
    for (int i = 0; i < 3; ++i) {
      const Real jump = now.jump[i] - before[f].jump[i];
      const Real traction = now.traction[i] - before[f].traction[i];
      here[0] -= area * traction * jump;
      here[1] += area * now.augmentation * jump * jump;
      here[2] += area * jump * jump;
      here[3] += area * traction * traction;
    }
  }
  Teuchos::reduceAll(*comm(), Teuchos::REDUCE_SUM, 4, here.data(), all.data());
  const Real noticeable = 1e-4 * scales_.length;  // without friction no work is done on closed faces
  if (!(all[2] > noticeable * noticeable * face_area_ && all[0] > 1e-2 * std::sqrt(all[2] * all[3]))) return false;
  const Real ratio = all[0] / all[1] / usual;
  calibrated_ = true;
  grips_.clear();
  if (ratio > 1 / near && ratio < near) return false;
  augmentation_ *= ratio;
  return true;
}

}  // namespace sprekk::assembly
