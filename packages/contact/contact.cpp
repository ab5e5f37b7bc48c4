#include "contact/contact.hpp"

#include "base/host_table.hpp"
#include "base/over_ranks.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace sprekk::contact {

using fields::BlockVector;

Contact::Contact(Equations& equations, RCP<const mesh::Mesh> mesh, Blocks blocks,
                 std::unique_ptr<FloatingPieces> pieces)
    : equations_(equations), mesh_(std::move(mesh)), blocks_(blocks) {
  if (pieces && pieces->possible()) pieces_ = std::move(pieces);
}

void Contact::remove_rigid_motions(const fields::Layout& displacement) {
  deformation_ = rcp(new fields::Vector(displacement.ghosted()));
}

BlockVector Contact::without_rigid_motions(const BlockVector& ghosted) {
  auto x = ghosted;
  if (deformation_.is_null()) return x;
  Tpetra::deep_copy(*deformation_, *ghosted[blocks_.motion]);
  pieces_->remove_rigid(*deformation_);
  x[blocks_.motion] = deformation_;
  return x;
}

void Contact::remember(const BlockVector& x) {
  if (pieces_) committed_ = rcp(new fields::Vector(*x[blocks_.motion], Teuchos::Copy));
}

void Contact::resume(const BlockVector& x, const std::vector<Real>& calibration) {
  remember(x);
  calibration_ = calibration;
  regularisation_.augmentation = {};
  if (!calibration_.empty()) correct_augmentation(equations_.contact_constraints(x));
}

void Contact::damp(Real everywhere, const std::vector<Real>& here) {
  damped_everywhere_ = everywhere;
  regularisation_.damping = {};
  if (everywhere == 0 && here.empty()) return;
  const base::HostTable<Real*> damping("damping", mesh_->n_owned_fracture_faces);
  for (std::size_t f = 0; f < damping.extent(0); ++f) damping(f) = std::max(everywhere, here.empty() ? 0 : here[f]);
  regularisation_.damping = damping.on_device();
}

bool Contact::set_proximal_term(Real stiffness, const fields::Evaluation& x) {
  regularisation_.proximal = 0;
  equations_.restart_row_sizes();
  if (stiffness == 0 || blocks_.multiplier < 0) return blocks_.multiplier >= 0;
  const auto constrained = equations_.contact_constraints(x);
  const int dim = mesh_->dim();
  const base::HostTable<Real**> anchor("anchor", constrained.size(), 2 * dim);
  for (std::size_t f = 0; f < constrained.size(); ++f)
    for (int i = 0; i < dim; ++i) {
      anchor(f, i) = constrained[f].jump[i];
      anchor(f, dim + i) = constrained[f].traction[i];
    }
  regularisation_.anchor = anchor.on_device();
  regularisation_.proximal = stiffness;
  return true;
}

bool Contact::weakens(const fields::Evaluation& x) {
  const auto constraints = equations_.contact_constraints(x);
  return base::on_any_rank(*mesh_->comm, std::any_of(constraints.begin(), constraints.end(),
                                                     [](const Constraint& constraint) { return constraint.weakens; }));
}

std::size_t Contact::state_hash(const std::vector<char>& states) {
  std::size_t here = 0;
  for (std::size_t f = 0; f < states.size(); ++f) {
    std::size_t h = static_cast<std::size_t>(mesh_->fracture_faces[f].id) * 4 + static_cast<std::size_t>(states[f]) + 1;
    for (int round = 0; round < 2; ++round) {  // mixing function of splitmix64 (Steele, Lea and Flood 2014)
      h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ULL;
      h = (h ^ (h >> 27)) * 0x94d049bb133111ebULL;
    }
    here += h;
  }
  // sums of halves: signed sums must not overflow; the sum modulo 2^64 does not depend on the partition
  const auto sums = base::sum_over_ranks(
      *mesh_->comm, std::array{static_cast<long long>(here & 0xffffffff), static_cast<long long>(here >> 32)});
  return static_cast<std::size_t>(sums[0]) + (static_cast<std::size_t>(sums[1]) << 32);
}

std::string Contact::where(const std::vector<char>& flagged) {
  const auto& names = mesh_->fracture_names;
  std::vector<long long> here(names.size(), 0);
  std::array<Real, 3> nowhere, lowest, highest;
  nowhere.fill(std::numeric_limits<Real>::max());
  std::array<std::array<Real, 3>, 2> ends{nowhere, nowhere};  // minima of x and -x
  for (std::size_t f = 0; f < flagged.size(); ++f) {
    if (!flagged[f]) continue;
    const auto& face = mesh_->fracture_faces[f];
    ++here[face.fracture];
    for (int i = 0; i < 3; ++i) {
      ends[0][i] = std::min(ends[0][i], face.centre[i]);
      ends[1][i] = std::min(ends[1][i], -face.centre[i]);
    }
  }
  const auto all = base::sum_over_ranks(*mesh_->comm, here);
  const std::array reach = {base::min_over_ranks(*mesh_->comm, ends[0]), base::min_over_ranks(*mesh_->comm, ends[1])};
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (all[k] > 0) parts.push_back(fmt::format("{} of \"{}\"", all[k], names[k]));
  if (parts.empty()) return "";
  for (int i = 0; i < 3; ++i) {
    lowest[i] = reach[0][i];
    highest[i] = -reach[1][i];
  }
  const Real size = mesh::norm(lowest) + mesh::norm(highest);
  return fmt::format("{}, between {} and {}", fmt::join(parts, ", "), to_text(lowest, mesh_->dim(), size),
                     to_text(highest, mesh_->dim(), size));
}

}  // namespace sprekk::contact
