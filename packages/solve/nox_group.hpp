// Iterate of Newton's method, for NOX.
#pragma once

#include <NOX_Abstract_Group.H>
#include <NOX_Abstract_Vector.H>

#include <Thyra_DefaultProductVectorSpace.hpp>

#include "fields/block_problem.hpp"

namespace sprekk::solve {

using fields::BlockProblem;
using fields::BlockVector;
using fields::Evaluation;

/// Returns the Tpetra vectors of a vector of NOX without copying. Do not write to the result if the argument is const.
BlockVector blocks_of(const NOX::Abstract::Vector& v);

/// x with its evaluation and f(x) = problem.residual(x), as product vectors of all blocks. Copies share these vectors,
/// which never change. There is no Jacobian, and thus no gradient: NewtonStep computes the direction. Refers to the
/// problem.
class NoxGroup : public NOX::Abstract::Group {
 public:
  using Vector = NOX::Abstract::Vector;

  NoxGroup(BlockProblem& problem, const Evaluation& x);
  NoxGroup(const NoxGroup&) = default;

  const Evaluation& x() const { return at_; }
  BlockVector f() const { return blocks_of(*f_); }
  void move_to(const Evaluation& x);
  /// Discards f(x), after f has changed.
  void forget_f() { f_ = Teuchos::null; }

  NoxGroup& operator=(const NoxGroup& other) {
    at_ = other.at_;
    x_ = other.x_;
    f_ = other.f_;
    return *this;
  }
  NOX::Abstract::Group& operator=(const NOX::Abstract::Group& other) override {
    return *this = dynamic_cast<const NoxGroup&>(other);
  }
  RCP<NOX::Abstract::Group> clone(NOX::CopyType) const override { return rcp(new NoxGroup(*this)); }
  void setX(const Vector& x) override { set(x.clone()); }
  void computeX(const NOX::Abstract::Group& from, const Vector& dx, double length) override;
  ReturnType computeF() override;
  bool isF() const override { return !f_.is_null(); }
  const Vector& getX() const override { return *x_; }
  const Vector& getF() const override { return *f_; }
  double getNormF() const override { return f_->norm(); }
  const Vector& getGradient() const override { return *getGradientPtr(); }
  const Vector& getNewton() const override { return *getNewtonPtr(); }
  RCP<const Vector> getXPtr() const override { return x_; }
  RCP<const Vector> getFPtr() const override { return f_; }
  RCP<const Vector> getGradientPtr() const override { return Teuchos::null; }
  RCP<const Vector> getNewtonPtr() const override { return Teuchos::null; }

 private:
  void set(const RCP<const Vector>& x);

  BlockProblem& problem_;
  RCP<const Thyra::DefaultProductVectorSpace<Real>> space_;
  Evaluation at_;
  RCP<const Vector> x_, f_;  // f_ is null before computeF()
};

}  // namespace sprekk::solve
