// Values of fields on a bisected mesh, from those on the mesh before.
#pragma once

#include "fields/layout.hpp"
#include "mesh/bisect.hpp"
#include "mesh/facets.hpp"

#include <array>
#include <map>
#include <utility>
#include <vector>

namespace sprekk::assembly {

/// Linear map of the values of fields from a mesh of triangles or tetrahedra to a mesh with bisected cells. Each cell
/// of the fine mesh has a parent in the coarse mesh, which contains it. After nodes have moved, a parent that contains
/// its cell only approximately is extrapolated, except for fields on cells. New fracture faces without a parent face
/// receive nothing.
///
/// | entity        | value on the fine mesh                                              | amounts             |
/// | node          | finite-element function of the parent at the node                   | -                   |
/// | enriched node | sum of N_c rho^(-1/2) q_c of the parent at the node, see TipCell    | -                   |
/// | cell          | value of the parent; with overlaps: mean of linear functions in the | by volume           |
/// |               | coarse cells, with gradients from the cells at their nodes          |                     |
/// | fracture face | value of the parent face                                            | by area             |
/// | facet         | on a facet of the parent: its value; otherwise linear function with | by area; 0 inside   |
/// |               | the values of the parent's facets at their centres                  | of the parent       |
///
/// Constants are reproduced, and on nodes all functions of the coarse space. On cells with overlaps, linear functions
/// are reproduced, and integrals remain. Amounts (Field::is_amount) are divided among the children; their sum remains,
/// except on facets with overlaps. The functions of enriched nodes are reproduced in cells whose nodes off the tip have
/// equal rho in the parent. The results do not depend on the number of ranks, except for rounding.
class Prolongation {
 public:
  /// `parent` [cell of the whole fine mesh]: number of the parent in the whole coarse mesh. `overlaps`: see
  /// mesh::Bisection. Both are read on rank 0 only. Collective.
  Prolongation(const mesh::Mesh& coarse, const mesh::Mesh& fine, const std::vector<GlobalIndex>& parent,
               const std::vector<mesh::Overlap>& overlaps = {});

  bool has_overlaps() const { return has_overlaps_; }

  /// Adds the values of a field, [owned entity, component]. Collective.
  void add(const fields::Field& field, const View<Real**>& coarse, const View<Real**>& fine) const;
  /// Adds the part of the enriching field to the values of the enriched field at nodes. Collective.
  void add_enrichment(const fields::Field& enriching, const View<Real**>& coarse, const View<Real**>& fine) const;

 private:
  using Point = mesh::Vector;
  using Weights = std::vector<Real>;  ///< [place in the parent]

  /// Intersection of a fine cell with a coarse cell.
  struct Part {
    LocalIndex parent;  ///< index into parents_
    Real area;          ///< m^2
    Point centre;       ///< centroid, m
  };

  std::vector<std::pair<LocalIndex, mesh::Overlap>> local_parts(const std::vector<mesh::Overlap>& overlaps,
                                                                const std::vector<GlobalIndex>& here);
  std::vector<Real> gradients(const fields::Field& field, const View<Real**>& values) const;
  void add_to_cells(const fields::Field& field, const View<Real**>& coarse, const View<Real**>& fine) const;
  std::vector<Real> of_parents(const std::vector<Real>& of_cells, int n) const;
  std::vector<Real> table(const fields::Field& field, const View<Real**>& values) const;
  template <class Set>
  void add_weighted(const fields::Field& of_table, const View<Real**>& coarse, fields::Entity entity,
                    const View<Real**>& fine, const Set& set) const;
  template <class Visit>
  void for_each_place(fields::Entity entity, const Visit& visit) const;
  std::array<Point, 4> corners_of(LocalIndex parent) const;
  std::array<Point, 4> parent_corners(LocalIndex cell) const { return corners_of(parent_[cell]); }
  std::array<Real, 4> barycentric(LocalIndex cell, const Point& x) const;
  std::vector<Real> shape_functions(LocalIndex cell, int node) const;
  Real share_of_tips(LocalIndex cell, std::vector<Real>& N) const;
  int parent_face(LocalIndex cell, int face) const;
  Real share_of_volume(LocalIndex cell) const;
  Real share_of_area(LocalIndex cell, int face, int parent_face) const;
  void set_facet(LocalIndex cell, int place, bool is_amount, Weights& weights) const;
  void set_ridge(LocalIndex cell, int face, int ridge, bool is_amount, Weights& weights) const;
  bool set(const fields::Field& field, LocalIndex cell, int place, Weights& weights) const;

  const mesh::Mesh *coarse_, *fine_;
  std::vector<GlobalIndex> parents_;               // cells of the whole coarse mesh, increasing
  std::vector<LocalIndex> parent_;                 // [local fine cell] index into parents_
  std::vector<LocalIndex> order_;                  // local fine cells by their numbers in the whole mesh
  std::vector<Real> coordinates_;                  // [parent, node, component]
  std::vector<Real> tips_;                         // [parent, node] 1 at tips
  bool has_overlaps_ = false;                      // on any rank
  std::map<LocalIndex, std::vector<Part>> parts_;  // [local fine cell with overlaps]
};

}  // namespace sprekk::assembly
