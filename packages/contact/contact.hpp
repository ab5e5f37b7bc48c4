// Contact of bodies as part of a block system: globalisation of Newton's method where faces open, stick and slip.
#pragma once

#include "contact/constraint.hpp"
#include "contact/floating_pieces.hpp"
#include "fields/globalisation.hpp"

#include <memory>
#include <string>
#include <vector>

namespace sprekk::contact {

/// Typical sizes under the present loads; zero for absent quantities.
struct Sizes {
  Real motion = 0;      ///< displacement, m
  Real force = 0;       ///< row of the displacement, N (N/m in 2D)
  Real multiplier = 0;  ///< traction, Pa
  Real gap = 0;         ///< jump in traction rows, m
  Real extent = 0;      ///< largest extent of the domain, m
};

/// Interface to the equations that include contact. All members except sizes() are collective.
class Equations {
 public:
  virtual ~Equations() = default;
  /// Computes r = f(x).
  virtual void residual(const fields::Evaluation& x, fields::BlockVector& r) = 0;
  /// Returns the contact constraints, [owned fracture face].
  virtual std::vector<Constraint> contact_constraints(const fields::Evaluation& x) = 0;
  /// Returns the contact states, [owned fracture face].
  virtual std::vector<char> states(const fields::Evaluation& x) = 0;
  virtual Sizes sizes() const = 0;
  /// Starts a new solve: the round-off of the last Jacobian no longer applies.
  virtual void restart_row_sizes() = 0;
};

/// Block numbers of contact; -1: absent.
struct Blocks {
  int motion = -1;      ///< displacement of bodies that may be supported by contact alone
  int multiplier = -1;  ///< contact traction
};

/// Globalisation for bodies in contact. Theory: docs/model/contact.md. All members are collective unless they return
/// stored data.
class Contact : public fields::Globalisation {
 public:
  /// `equations` must outlive this object. `pieces`: pieces of the displacement; null without a displacement.
  Contact(Equations& equations, RCP<const mesh::Mesh> mesh, Blocks blocks, std::unique_ptr<FloatingPieces> pieces);

  /// Returns the present modifications of the face laws. Stored data.
  const Regularisation& regularisation() const { return regularisation_; }
  /// Returns the pieces; null if no piece can float. Stored data.
  const FloatingPieces* pieces() const { return pieces_.get(); }
  /// Enables without_rigid_motions().
  void remove_rigid_motions(const fields::Layout& displacement);
  /// Returns the ghosted unknowns, [block], without the rigid motions of pieces. Otherwise, round-off in stiff pieces
  /// may be as large as the stresses in soft ones. Returns the unknowns unchanged unless remove_rigid_motions() was
  /// called.
  fields::BlockVector without_rigid_motions(const fields::BlockVector& ghosted);

  /// Starts a step: floating() again assumes that the last place_at_minimum_norm() succeeded. Local.
  void begin_step() { nearest_known_ = true; }
  /// Finds the floating pieces for the contact constraints of the last Jacobian or of the accepted state.
  void find_floating(std::vector<Constraint> constraints);
  /// Saves x as the last accepted state.
  void remember(const fields::BlockVector& x);

  /// Returns the factor of the augmentation constant, [class of faces]; 0: not yet compared with the rock. Stored data.
  const std::vector<Real>& calibration() const { return calibration_; }
  /// Continues from the accepted state x with these factors. Throws an Error for a wrong number of factors.
  void resume(const fields::BlockVector& x, const std::vector<Real>& calibration);

  std::vector<char> states(const fields::Evaluation& x) override { return equations_.states(x); }
  bool weakens(const fields::Evaluation& x) override;
  std::size_t state_hash(const std::vector<char>& states) override;
  std::string where(const std::vector<char>& flagged) override;
  RCP<const fields::Vector> proximal(int block) const override;
  std::string balance(const fields::Evaluation& x, fields::BlockVector& dx, fields::Evaluation& end) override;
  std::string floating() const override;
  void damp(Real everywhere, const std::vector<Real>& here) override;
  bool set_proximal_term(Real stiffness, const fields::Evaluation& x) override;
  bool calibrate(const fields::Evaluation& x, bool first) override;
  bool place_at_minimum_norm(fields::Evaluation& x) override;

 private:
  int calibration_class(const Constraint& constraint) const;
  void correct_augmentation(const std::vector<Constraint>& constraints);
  /// Adds to dx the multiple of a motion that balances the forces along it. With `mode`, the multiple may be negative.
  /// Returns an empty string, or a description of the part without resistance. That part moves by the displacement
  /// scale; a mode does not move.
  std::string balance_along(const FloatingPieces::Motion& motion, const fields::BlockVector& x, fields::BlockVector& dx,
                            fields::Evaluation& end, bool mode);
  std::vector<Real> work(const FloatingPieces::Motion& motion, const fields::Evaluation& x);
  fields::Evaluation after(const fields::Evaluation& x, const std::vector<RigidRow>& motion) const;
  fields::Evaluation way_back(const fields::Evaluation& x, const std::vector<FloatingPieces::Slide>& slides,
                              const std::vector<Real>& minimum, fields::Evaluation& unobstructed);

  Equations& equations_;
  RCP<const mesh::Mesh> mesh_;
  Blocks blocks_;
  std::unique_ptr<FloatingPieces> pieces_;  // null: no piece can float
  RCP<fields::Vector> committed_;           // displacement; null without pieces_
  RCP<fields::Vector> deformation_;         // ghosted displacement without rigid motions; null: not needed
  FloatingPieces::Motion driven_;           // motion of floating pieces by unbalanced forces; empty: none
  bool nearest_known_ = true;               // the last place_at_minimum_norm() found the minimum-norm position
  Regularisation regularisation_;
  Real damped_everywhere_ = 0;
  std::vector<Constraint> constraints_;  // of the last calibrate()
  std::vector<Real> calibration_;
};

}  // namespace sprekk::contact
