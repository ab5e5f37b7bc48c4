// Floating pieces of rock, supported neither by boundary conditions nor by the present contact.
#pragma once

#include "contact/constraint.hpp"
#include "contact/rigid_motion.hpp"
#include "fields/layout.hpp"
#include "fields/types.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::contact {

/// Floating pieces and their free motions. If all faces of a piece are open or slide in one direction, the piece can
/// move as a rigid body. Nothing resists this motion, and the Jacobian is singular. The free motions follow from the
/// contact constraints between pairs of pieces, summed over their faces; a face acts at its centre. A motion that other
/// terms resist (Constraint::resisted) is not free. All members are collective unless they return stored data.
class FloatingPieces {
 public:
  /// displacement: layout of the field of `supports`. volumes: [local cell], m^3 (m^2 in 2D).
  FloatingPieces(RCP<const mesh::Mesh> mesh, const fields::Layout& displacement, const std::vector<Support>& supports,
                 const std::vector<Real>& volumes);

  /// Returns whether boundary conditions alone leave a piece free. If not, no other member is needed. Stored data.
  bool possible() const { return !candidates_.empty(); }

  /// Returns the stiffness of the stiffest piece relative to the softest, from the diagonal. Stored data.
  Real contrast() const { return contrast_; }
  /// Subtracts the rigid motion of each piece from u [local node, component]. The motion is the least-squares fit to
  /// the owned nodes of all ranks. The deformation of the rock remains unchanged. Pieces with shared nodes keep their
  /// motion.
  void remove_rigid(fields::Vector& ghosted) const;
  /// Sets u [local node, component] to rigid mode k in pieces treated by remove_rigid(), and to 0 in others. Local.
  void set_rigid(int k, fields::Vector& ghosted) const;

  /// Finds the free motions for the contact constraints [owned fracture face].
  void find(const std::vector<Constraint>& constraints);
  /// Returns whether find() found a free motion. Stored data.
  bool any() const { return !floating_.empty(); }

  /// Returns whether find() found a free motion, or one that only Constraint::resisted prevents. Stored data.
  bool any_weakly_held() const { return any() || weakly_held_; }

  /// Returns the diagonal that makes the Jacobian regular, [owned unknown]: 1e-4 of the stiffness of the softest piece
  /// against deformation, in proportion to the volume. It is 1e-12 of this stiffness in pieces whose motion only
  /// Constraint::resisted prevents, and zero in others. Stored data.
  const fields::Vector& proximal() const { return *proximal_; }
  /// Sets the diagonal of the rock, [owned unknown]. Call before the first find().
  void set_stiffness(const fields::Vector& diagonal);

  /// Returns the number of groups of floating pieces. Groups move independently of each other. Stored data.
  int n_groups() const { return static_cast<int>(groups_.size()); }

  /// Free motion of all floating pieces.
  struct Motion {
    std::vector<RigidRow> q;    ///< [floating piece] rigid coordinates
    std::vector<Real> largest;  ///< [group] largest displacement, m
  };
  /// Returns the free motion contained in a displacement [owned unknown], by least squares.
  Motion part_of(const fields::Vector& displacement) const;
  /// Adds s [group] times a motion to the displacement. Local.
  void add(const std::vector<Real>& s, const Motion& motion, fields::Vector& displacement) const;
  /// Returns the work on the motion, [group], N m (N in 2D), of a residual [owned unknown] and the excess tractions.
  /// The residual is the negative force on the rock. The work is zero in equilibrium under the tractions of the laws.
  std::vector<Real> work(const Motion& motion, const fields::Vector& residual,
                         const std::vector<Constraint>& constraints) const;
  /// Face that slides under constant forces and may continue to slide. A motion v adds `along` . [[v]] to its slip
  /// `done`.
  struct Slide {
    LocalIndex face;  ///< owned
    mesh::Vector along;
    Real done;     ///< m
    bool one_way;  ///< the slip must not become negative
  };
  /// Inequality normal . [[v]] >= least on a fracture face, for a displacement v.
  struct Obstacle {
    LocalIndex face;  ///< owned
    mesh::Vector normal;
    Real minimum;
  };
  /// Coordinates x of all free motions: v = nearest + sum_k x_k axes[k], [floating piece]. The distance is |x|.
  struct Places {
    std::vector<RigidRow> nearest;
    std::vector<std::vector<RigidRow>> axes;
    Real unit;  ///< size of x for v of about 1 m
  };
  /// Returns these coordinates. First, the sum over the slides of all ranks |f| (along . [[v]] + done)^2 is minimised.
  /// Motions without influence on this sum minimise `displacement` + v [owned unknown] in the norm of proximal().
  Places places(const fields::Vector& displacement, const std::vector<Slide>& slides) const;
  /// Returns the free motion, [floating piece], nearest to x = 0 that satisfies the obstacles of all ranks. No value:
  /// none does, or none was found. Obstacles that no free motion affects are ignored. unit: typical length, m. The
  /// result is unique.
  std::optional<std::vector<RigidRow>> nearest(const Places& places, const std::vector<Obstacle>& obstacles,
                                               Real unit) const;
  /// Returns the jump of a free motion at the centre of an owned fracture face, m, global frame. Stored data.
  mesh::Vector jump(LocalIndex face, const std::vector<RigidRow>& motion) const;
  /// Returns whether a side of an owned fracture face belongs to a floating piece. Stored data.
  bool is_beside(LocalIndex face) const;

  /// Returns the motion of the selected groups only; empty if none is selected. Stored data.
  Motion selected(const Motion& motion, const std::function<bool(int)>& group_is) const;
  /// max_modes: largest number of independent motions of a group. mode: k-th motion of each group with more than k.
  /// Stored data.
  int max_modes() const;
  Motion mode(int k) const;
  /// Returns one of the free motions, a translation if there is one. Stored data.
  Motion first() const;
  /// Returns the description of the piece with the largest motion, e.g. "a piece of rock around (0, 1) (12 cells) and 2
  /// more can move along (1, 0)". Stored data.
  std::string describe(const Motion& motion) const;

 private:
  struct Pair {
    int a, b;  ///< pieces, a < b
  };
  /// Node at two positions (periodic sides), or in two pieces that touch at a corner or an edge.
  struct Tie {
    int a, b, pair;  ///< pieces, a <= b; number of the pair, -1: one piece
    mesh::Vector at_a, at_b;
  };
  struct Group {
    int first;                             ///< first floating piece; those of a group are consecutive
    std::vector<std::vector<Real>> modes;  ///< [mode][floating piece * modes of a body + mode of the body]
  };
  using Motions = std::vector<std::vector<RigidRow>>;  ///< [mode][floating piece]
  /// Quadratic form z . matrix z + 2 z . vector, with z [mode].
  struct Form {
    std::vector<Real> matrix, vector;
    explicit Form(std::size_t n) : matrix(n * n, 0), vector(n, 0) {}
  };
  struct Neighbour {
    int pair, piece;
    bool first;  ///< this piece is `a` of the pair
  };

  void measure_pieces(const fields::Layout& displacement, const std::vector<Real>& volumes);
  void find_ties(const fields::Layout& displacement);
  void pair_up();
  void constrain(const std::vector<Support>& supports);
  void find_pieces(const std::vector<Constraint>& constraints, bool with_resistance);
  void sum_pairs(const std::vector<Constraint>& constraints, bool with_resistance);
  std::vector<int> unconstrained() const;
  std::vector<std::vector<int>> coupled(const std::vector<int>& pieces) const;
  std::vector<Real> resistance(const std::vector<int>& pieces) const;
  void find_motions(const std::vector<int>& pieces);
  int group_of(int number) const;
  std::vector<Motions> motions_of_groups() const;
  std::vector<Form> distance_form(const std::vector<Motions>& motions, const fields::Vector& displacement) const;
  std::vector<Form> slip_form(const std::vector<Motions>& motions, const std::vector<Slide>& slides) const;
  const RigidBlock& block(int pair, int part) const { return pairs_sum_[3 * pair + part]; }
  mesh::Vector node(LocalIndex n) const;
  int dim() const { return mesh_->dim(); }

  RCP<const mesh::Mesh> mesh_;
  std::vector<RigidFrame> frames_;                  // [piece]
  std::vector<GlobalIndex> n_cells_;                // [piece]
  std::vector<int> piece_of_, piece_of_ghosts_;     // [owned node], [local node]
  std::vector<int> tied_;                           // [piece] shares nodes with another piece, or has periodic nodes
  std::vector<Real> volume_;                        // [owned node] share of the volume of the cells around, m^dim
  std::vector<Tie> ties_;                           // of the nodes of owned cells
  std::vector<Pair> pairs_;                         // pairs with a common fracture face or tied nodes, on any rank
  std::vector<int> pair_of_;                        // [owned fracture face], -1: one piece on both sides
  std::vector<std::vector<Neighbour>> neighbours_;  // [piece]
  std::vector<RigidBlock> support_;                 // [piece] sum over prescribed unknowns and own ties
  std::vector<RigidBlock> inertia_;                 // [piece] sum over nodes
  std::vector<int> candidates_;                     // pieces that boundary conditions alone do not support
  std::vector<RigidBlock> pairs_sum_;               // [3 pair + (aa, ab, bb)]
  std::vector<int> floating_;                       // floating pieces
  std::vector<int> floating_number_;                // [piece] index in floating_, or -1
  std::vector<Group> groups_;                       // in the order of their first pieces
  RCP<fields::Vector> stiffness_, proximal_;
  bool weakly_held_ = false;
  Real contrast_ = 1;
};

}  // namespace sprekk::contact
