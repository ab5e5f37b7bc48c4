#include "solve/minimal_residual.hpp"

#include <cmath>
#include <utility>

namespace sprekk::solve {

MinimalResidual::MinimalResidual(RCP<const fields::Operator> A, RCP<const fields::Operator> M,
                                 const fields::Vector& diagonal, int n_steps)
    : A_(std::move(A)),
      M_(std::move(M)),
      scale_(A_->getRangeMap()),
      unscale_(A_->getRangeMap()),
      x_(A_->getDomainMap()),
      r_(A_->getRangeMap()) {
  const auto d = diagonal.getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto scale = scale_.getLocalViewHost(Tpetra::Access::OverwriteAll),
             unscale = unscale_.getLocalViewHost(Tpetra::Access::OverwriteAll);
  for (std::size_t i = 0; i < d.extent(0); ++i) {
    unscale(i, 0) = d(i, 0) != 0 ? std::sqrt(std::abs(d(i, 0))) : 1;
    scale(i, 0) = 1 / unscale(i, 0);
  }
  for (int k = 0; k < n_steps; ++k) {
    directions_.push_back(rcp(new fields::Vector(A_->getDomainMap())));
    images_.push_back(rcp(new fields::Vector(A_->getRangeMap())));
  }
}

void MinimalResidual::apply(const fields::MultiVector& b, fields::MultiVector& y, Teuchos::ETransp, Real alpha,
                            Real beta) const {
  for (std::size_t v = 0; v < b.getNumVectors(); ++v) {
    x_.putScalar(0);
    r_.elementWiseMultiply(1, scale_, *b.getVector(v), 0);
    for (std::size_t k = 0; k < directions_.size(); ++k) {
      auto &z = *directions_[k], &image = *images_[k];
      image.elementWiseMultiply(1, unscale_, r_, 0);
      M_->apply(image, z);
      A_->apply(z, image);
      image.elementWiseMultiply(1, scale_, image, 0);
      for (std::size_t j = 0; j < k; ++j) {
        const Real share = images_[j]->dot(image);
        image.update(-share, *images_[j], 1);
        z.update(-share, *directions_[j], 1);
      }
      const Real size = image.norm2();
      if (!(size > 0)) break;
      image.scale(1 / size);
      z.scale(1 / size);
      const Real step = image.dot(r_);
      x_.update(step, z, 1);
      r_.update(-step, image, 1);
    }
    y.getVectorNonConst(v)->update(alpha, x_, beta);
  }
}

RCP<const fields::Operator> minimal_residual(const RCP<const fields::Matrix>& A, const RCP<const fields::Operator>& M,
                                             int n_steps) {
  fields::Vector diagonal(A->row_map());
  A->copy_diagonal(diagonal);
  return rcp(new MinimalResidual(A, M, diagonal, n_steps));
}

}  // namespace sprekk::solve
