// Pieces of rock that neither boundary conditions nor the present contact hold.
#pragma once

#include "contact/grip.hpp"
#include "contact/rigid_motion.hpp"
#include "fields/layout.hpp"
#include "fields/types.hpp"

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sprekk::contact {

/// Where all faces of a piece are open, or slide one way, the piece can move as a rigid body and nothing resists: the
/// Jacobian is singular. Here such motions are found, from sums over faces of how pairs of pieces hold each other; a
/// face acts at its centre. All members are collective unless they return stored data.
class LoosePieces {
 public:
  /// `displacement` is the layout of the field that `supports` are of; `volumes` are those of cells, [local cell].
  LoosePieces(RCP<const mesh::Mesh> mesh, const fields::Layout& displacement, const std::vector<Support>& supports,
              const std::vector<Real>& volumes);

  /// Some piece is not held by boundary conditions alone; if none, nothing else here needs to be called. Stored data.
  bool possible() const { return !candidates_.empty(); }

  /// How much stiffer the stiffest piece is than the softest, as the diagonal tells. Stored data.
  Real contrast() const { return contrast_; }
  /// Takes from u [local node, component] the rigid motion of each piece that comes nearest to its owned part: what is
  /// left deforms the rock in the same way. Pieces that share nodes keep theirs.
  void remove_rigid(fields::Vector& ghosted) const;
  /// Sets u [local node, component] to mode k (of those of a body) in pieces that remove_rigid() takes it from, else 0.
  void set_rigid(int k, fields::Vector& ghosted) const;

  /// Finds the free motions for grips [owned fracture face].
  void find(const std::vector<Grip>& grips);
  /// Whether find() found one. Stored data.
  bool any() const { return !loose_.empty(); }

  /// To be added to the diagonal of the Jacobian so that it is regular, [owned unknown]: 1e-4 of the stiffness that a
  /// piece has against deformation, in proportion to volume, for the pieces that are loose; zero for others. Stored
  /// data.
  const fields::Vector& proximal() const { return *proximal_; }
  /// Before the first find(): the diagonal of the bulk, [owned unknown].
  void set_stiffness(const fields::Vector& diagonal);

  /// Pieces of one group hold each other; groups move independently. Stored data.
  int n_groups() const { return static_cast<int>(groups_.size()); }

  /// A free motion of all loose pieces.
  struct Motion {
    std::vector<RigidRow> q;    ///< [loose piece]
    std::vector<Real> largest;  ///< [group] size of the displacement, m
  };
  /// The part of a displacement [owned unknown] that is a free motion.
  Motion part_of(const fields::Vector& displacement) const;
  /// Adds s [group] times a motion to the displacement. Local.
  void add(const std::vector<Real>& s, const Motion& motion, fields::Vector& displacement) const;
  /// [group] Work of a residual [owned unknown], force on the rock with the opposite sign, and of the excess tractions
  /// on the motion: zero in equilibrium under the tractions that the law answers with. N m (N in 2D).
  std::vector<Real> work(const Motion& motion, const fields::Vector& residual, const std::vector<Grip>& grips) const;
  /// A face that slides without changing any force, and may go on: `along` . [[v]] is what v adds to its slip `done`.
  struct Slide {
    LocalIndex face;  ///< owned
    mesh::Vector along;
    Real done;     ///< m
    bool one_way;  ///< never below zero
  };
  /// normal . [[v]] >= least on a fracture face, of a displacement v.
  struct Obstacle {
    LocalIndex face;  ///< owned
    mesh::Vector normal;
    Real least;
  };
  /// All free motions v = nearest + sum_k x_k axes[k], [loose piece], in coordinates in which the distance is |x|.
  struct Places {
    std::vector<RigidRow> nearest;
    std::vector<std::vector<RigidRow>> axes;
    Real unit;  ///< of x, for v of about 1 m
  };
  /// First, sum_f |f| (along . [[v]] + done)^2 over the slides of all ranks is to be small; where that is left open,
  /// `displacement` + v [owned unknown] in the norm of proximal().
  Places places(const fields::Vector& displacement, const std::vector<Slide>& slides) const;
  /// The free motion, [loose piece], nearest to x = 0 among those that satisfy the obstacles of all ranks; nothing, if
  /// none does. Faces that no free motion moves that way are no obstacle. `unit`: a typical length, m. Unique.
  std::optional<std::vector<RigidRow>> nearest(const Places& places, const std::vector<Obstacle>& obstacles,
                                               Real unit) const;
  /// Jump of a free motion at the centre of an owned fracture face. Stored data.
  mesh::Vector jump(LocalIndex face, const std::vector<RigidRow>& motion) const;
  /// Whether a side of an owned fracture face is loose. Stored data.
  bool is_beside(LocalIndex face) const;

  /// The motion of some groups alone; empty if there is none. Stored data.
  Motion selected(const Motion& motion, const std::function<bool(int)>& group_is) const;
  /// The largest number of independent motions of a group, and the k-th of each group that has as many. Stored data.
  int most_modes() const;
  Motion mode(int k) const;
  /// One of the free motions, a translation if there is one. Stored data.
  Motion first() const;
  /// "a piece of rock around (0, 1) (12 cells) and 2 more can move along (1, 0)" for the piece that moves most. Stored
  /// data.
  std::string describe(const Motion& motion) const;

 private:
  struct Pair {
    int a, b;  ///< pieces, a < b
  };
  /// One node in two places by periodicity, or in two pieces that touch in a corner or an edge.
  struct Tie {
    int a, b, pair;  ///< pieces, a <= b; -1: one piece
    mesh::Vector at_a, at_b;
  };
  struct Group {
    int first;                             ///< of its loose pieces, which follow one another
    std::vector<std::vector<Real>> modes;  ///< [mode][loose piece * modes of a body + mode of the body]
  };
  using Motions = std::vector<std::vector<RigidRow>>;  ///< [mode][loose piece]
  /// z . matrix z + 2 z . vector, of z [mode].
  struct Form {
    std::vector<Real> matrix, vector;
    explicit Form(std::size_t n) : matrix(n * n, 0), vector(n, 0) {}
  };
  struct Neighbour {
    int pair, piece;
    bool first;  ///< this piece is the pair's a
  };

  void measure_pieces(const fields::Layout& displacement, const std::vector<Real>& volumes);
  void find_ties(const fields::Layout& displacement);
  void pair_up();
  void hold(const std::vector<Support>& supports);
  void sum_pairs(const std::vector<Grip>& grips);
  std::vector<int> unheld() const;
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
  std::vector<int> tied_;                           // [piece] shares nodes with another piece, or has periodic ones
  std::vector<Real> volume_;                        // [owned node] share of the cells around, m^dim
  std::vector<Tie> ties_;                           // of nodes of owned cells
  std::vector<Pair> pairs_;                         // that share a fracture face or tied nodes, on any rank
  std::vector<int> pair_of_;                        // [owned fracture face], -1: one piece on both sides
  std::vector<std::vector<Neighbour>> neighbours_;  // [piece]
  std::vector<RigidBlock> support_;                 // [piece] sum over prescribed unknowns, and ties with itself
  std::vector<RigidBlock> inertia_;                 // [piece] sum over nodes
  std::vector<int> candidates_;                     // pieces that conditions alone do not hold
  std::vector<RigidBlock> pairs_sum_;               // [3 pair + (aa, ab, bb)]
  std::vector<int> loose_;                          // pieces
  std::vector<int> loose_number_;                   // [piece] in loose_, -1
  std::vector<Group> groups_;                       // by their first pieces
  RCP<fields::Vector> stiffness_, proximal_;
  Real contrast_ = 1;
};

}  // namespace sprekk::contact
