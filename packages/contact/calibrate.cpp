// Calibration of the augmentation constant by the stiffness of the rock.
#include "contact/contact.hpp"

#include "base/check.hpp"
#include "base/host_table.hpp"
#include "base/over_ranks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace sprekk::contact {

namespace {

constexpr Real usual = 3;          ///< typical stiffness of the rock, measured as below, relative to the constant
constexpr Real near = 10;          ///< the constant remains if the ratio is within this factor
constexpr Real noticeable = 1e-4;  ///< smallest change of jumps and tractions, relative to the scales
constexpr int n_classes = 25;      ///< number of stiffness classes, decades
enum Sum { worked, of_constant, moved, loaded, noticed, area, n_sums };

bool is_open(const Constraint& constraint) { return constraint.constrained == std::array<mesh::Vector, 3>{}; }

}  // namespace

/// Returns the stiffness class of a face: decades relative to the stiffest rock, E = sigma L / u from the scales.
int Contact::calibration_class(const Constraint& constraint) const {
  const auto sizes = equations_.sizes();
  const Real decade = std::round(std::log10(constraint.modulus * sizes.gap / (sizes.multiplier * sizes.extent)));
  return static_cast<int>(std::clamp<Real>(decade + n_classes / 2, 0, n_classes - 1));
}

/// Compares the stiffness of the rock with the augmentation constant. Between two balanced iterates it is
///   - sum |f| dlambda . dw / sum |f| |dw|^2
/// over the faces of one class that remain closed. Larger deformations have a larger weight. Each class is measured
/// once: the stiffness is constant, but between later iterates, separating blocks move far without elastic resistance.
/// If sides approach each other under a constant load, the traction does not change. Round-off of the traction is not a
/// stiffness.
bool Contact::calibrate(const fields::Evaluation& x, bool first) {
  if (blocks_.multiplier < 0) return false;
  calibration_.resize(n_classes, 0);
  if (std::find(calibration_.begin(), calibration_.end(), 0) == calibration_.end()) return false;
  const auto before = std::exchange(constraints_, equations_.contact_constraints(x));
  if (first) return false;
  const auto sizes = equations_.sizes();
  const Real stress = sizes.multiplier, length = sizes.gap;
  std::array<std::array<Real, n_sums>, n_classes> here{};
  for (std::size_t f = 0; f < constraints_.size(); ++f) {
    const auto& now = constraints_[f];
    auto& sums = here[calibration_class(now)];
    const Real size = mesh_->fracture_faces[f].area;
    sums[area] += size;
    sums[noticed] += size * std::pow(noticeable * std::min(stress, now.modulus * length / sizes.extent), 2);
    if (is_open(now) || is_open(before[f])) continue;
    for (int i = 0; i < 3; ++i) {
      const Real jump = now.jump[i] - before[f].jump[i];
      const Real traction = now.traction[i] - before[f].traction[i];
      sums[worked] -= size * traction * jump;
      sums[of_constant] += size * now.augmentation * jump * jump;
      sums[moved] += size * jump * jump;
      sums[loaded] += size * traction * traction;
    }
  }
  const auto all = base::sum_over_ranks(*mesh_->comm, here);
  bool corrected = false;
  for (int k = 0; k < n_classes; ++k) {
    const auto& sums = all[k];
    if (sums[area] == 0) calibration_[k] = 1;
    if (calibration_[k] != 0 || !(sums[moved] > std::pow(noticeable * length, 2) * sums[area]) ||
        !(sums[loaded] > sums[noticed]))
      continue;
    if (!(sums[worked] > 1e-2 * std::sqrt(sums[moved] * sums[loaded]))) continue;  // zero without friction
    const Real ratio = sums[worked] / sums[of_constant] / usual;
    const bool stays = ratio > 1 / near && ratio < near;
    calibration_[k] = stays ? 1 : ratio;
    corrected |= !stays;
  }
  if (corrected) correct_augmentation(constraints_);
  return corrected;
}

/// Sets the factors of all faces from their classes.
void Contact::correct_augmentation(const std::vector<Constraint>& constraints) {
  SPREKK_CHECK(calibration_.size() == n_classes, "the calibration has {} factors, there must be {}",
               calibration_.size(), n_classes);
  std::vector<Real> factor;
  for (const auto& constraint : constraints) {
    const Real correction = calibration_[calibration_class(constraint)];
    factor.push_back(correction != 0 ? correction : 1);
  }
  regularisation_.augmentation = base::to_device(factor, "factor");
}

}  // namespace sprekk::contact
