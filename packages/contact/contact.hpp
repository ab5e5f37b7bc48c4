// Bodies in contact, as the unknowns of a block system: what Newton's method needs where faces open, stick and slip.
#pragma once

#include "contact/grip.hpp"
#include "contact/loose_pieces.hpp"
#include "fields/globalisation.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::contact {

/// Typical sizes under the present loads. Those of what there is not are zero.
struct Sizes {
  Real displacement = 0;  ///< m
  Real force = 0;         ///< of a row of the displacement, N (N/m in 2D)
  Real traction = 0;      ///< Pa
  Real jump = 0;          ///< in rows of tractions, m
  Real extent = 0;        ///< of the domain, m
};

/// The equations that contact is part of. All members are collective but for sizes().
class Equations {
 public:
  virtual ~Equations() = default;
  /// r = f(x), and how the faces hold each other there, [owned fracture face].
  virtual std::vector<Grip> evaluate(const fields::BlockVector& x, fields::BlockVector& r) = 0;
  virtual std::vector<Grip> grips(const fields::BlockVector& x) = 0;
  /// [owned fracture face]
  virtual std::vector<char> states(const fields::BlockVector& x) = 0;
  virtual Sizes sizes() const = 0;
  /// A solve begins anew: the last Jacobian says nothing of its rounding.
  virtual void begin_anew() = 0;
};

/// Where contact is among the blocks; -1: there is none.
struct Blocks {
  int displacement = -1;  ///< of bodies that faces alone may hold
  int traction = -1;
};

/// Globalisation for bodies in contact. Theory: docs/model/contact.md. All members are collective unless they return
/// stored data.
class Contact : public fields::Globalisation {
 public:
  /// `equations` outlives it. `pieces`: of the displacement, null without one.
  Contact(Equations& equations, RCP<const mesh::Mesh> mesh, Blocks blocks, std::unique_ptr<LoosePieces> pieces);

  /// What faces are told from now on. Stored data.
  const Regularisation& regularisation() const { return regularisation_; }
  /// Null where no piece can be loose. Stored data.
  const LoosePieces* pieces() const { return pieces_.get(); }
  /// From now on without_rigid_motions() takes those away.
  void remove_rigid_motions(const fields::Layout& displacement);
  /// Of ghosted unknowns, [block], the same but for rigid motions of pieces: where some are much stiffer than others,
  /// stresses of these, zero but for rounding, would be as large as those of the soft ones.
  fields::BlockVector without_rigid_motions(const fields::BlockVector& ghosted);

  void begin_step() { nearest_known_ = true; }
  /// Of the Jacobian that was made last, or of the state that is accepted.
  void find_loose(std::vector<Grip> grips);
  /// Accepts x.
  void remember(const fields::BlockVector& x);

  /// [class of faces] factor of the face law's constant; 0: not yet compared with the rock. Stored data.
  const std::vector<Real>& calibration() const { return calibration_; }
  void resume(const fields::BlockVector& x, const std::vector<Real>& calibration);

  std::vector<char> states(const fields::BlockVector& x) override { return equations_.states(x); }
  bool weakens(const fields::BlockVector& x) override;
  std::size_t state_hash(const std::vector<char>& states) override;
  std::string where(const std::vector<char>& flagged) override;
  RCP<const fields::Vector> proximal(int block) const override;
  std::string balance(const fields::BlockVector& x, fields::BlockVector& dx) override;
  std::string loose() const override;
  void damp(Real everywhere, const std::vector<Real>& here) override;
  bool tether(Real stiffness, const fields::BlockVector& x) override;
  bool calibrate(const fields::BlockVector& x, bool first) override;
  bool settle(fields::BlockVector& x) override;

 private:
  int calibration_class(const Grip& grip) const;
  void correct_augmentation(const std::vector<Grip>& grips);
  /// Adds to dx what of a motion brings the forces along it into balance; with `mode`, of its opposite too. Empty, or
  /// the part that finds no resistance: it goes a little way then, as a mode none.
  std::string balance_along(const LoosePieces::Motion& motion, const fields::BlockVector& x, fields::BlockVector& dx,
                            bool mode);
  std::vector<Real> work(const LoosePieces::Motion& motion, const fields::BlockVector& x);
  std::optional<std::vector<RigidRow>> way_back(const fields::BlockVector& x,
                                                const std::vector<LoosePieces::Slide>& slides,
                                                const std::vector<Real>& least);

  Equations& equations_;
  RCP<const mesh::Mesh> mesh_;
  Blocks blocks_;
  std::unique_ptr<LoosePieces> pieces_;  // null: none can be loose
  RCP<fields::Vector> committed_;        // displacement; null without pieces_
  RCP<fields::Vector> deformation_;      // ghosted displacement without rigid motions; null: not needed
  LoosePieces::Motion driven_;           // where forces out of balance move what is loose, if they do
  bool nearest_known_ = true;            // the last settle() knew where what is loose comes to lie
  Regularisation regularisation_;
  Real damped_everywhere_ = 0;
  std::vector<Grip> grips_;  // of the last calibrate()
  std::vector<Real> calibration_;
};

}  // namespace sprekk::contact
