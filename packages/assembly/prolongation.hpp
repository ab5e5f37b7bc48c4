// Values of fields on a bisected mesh, from those on the mesh before.
#pragma once

#include "fields/layout.hpp"
#include "mesh/facets.hpp"

#include <array>
#include <vector>

namespace sprekk::assembly {

/// Linear map of the values of fields from a mesh of triangles or tetrahedra to a mesh with bisected cells. Each cell
/// of the fine mesh has a parent in the coarse mesh, which contains it. A parent that contains its cell only
/// approximately, after nodes have moved, is extrapolated. New fracture faces without a parent face receive nothing.
///
/// | entity        | value on the fine mesh                                              | amounts             |
/// | node          | finite-element function of the parent at the node                   | -                   |
/// | enriched node | sum of N_c rho^(-1/2) q_c of the parent at the node, see TipCell    | -                   |
/// | cell          | value of the parent                                                 | by volume           |
/// | fracture face | value of the parent face                                            | by area             |
/// | facet         | on a facet of the parent: its value; otherwise linear function with | by area; 0 inside   |
/// |               | the values of the parent's facets at their centres                  | of the parent       |
///
/// Constants are reproduced, and on nodes all functions of the coarse space. Amounts (Field::is_amount) are divided
/// among the children; their sum remains. The functions of enriched nodes are reproduced in cells whose nodes off the
/// tip have equal rho in the parent. The results do not depend on the number of ranks, except for rounding.
class Prolongation {
 public:
  /// `parent` [cell of the whole fine mesh]: number of the parent in the whole coarse mesh; read on rank 0 only.
  /// Collective.
  Prolongation(const mesh::Mesh& coarse, const mesh::Mesh& fine, const std::vector<GlobalIndex>& parent);

  /// Adds the values of a field, [owned entity, component]. Collective.
  void add(const fields::Field& field, const View<Real**>& coarse, const View<Real**>& fine) const;
  /// Adds the part of the enriching field to the values of the enriched field at nodes. Collective.
  void add_enrichment(const fields::Field& enriching, const View<Real**>& coarse, const View<Real**>& fine) const;

 private:
  using Point = mesh::Vector;
  using Weights = std::vector<Real>;  ///< [place in the parent]

  std::vector<Real> of_parents(const std::vector<Real>& of_cells, int n) const;
  std::vector<Real> table(const fields::Field& field, const View<Real**>& values) const;
  template <class Set>
  void add_weighted(const fields::Field& of_table, const View<Real**>& coarse, fields::Entity entity,
                    const View<Real**>& fine, const Set& set) const;
  template <class Visit>
  void for_each_place(fields::Entity entity, const Visit& visit) const;
  std::array<Point, 4> parent_corners(LocalIndex cell) const;
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
  std::vector<GlobalIndex> parents_;  // cells of the whole coarse mesh, increasing
  std::vector<LocalIndex> parent_;    // [local fine cell] index into parents_
  std::vector<LocalIndex> order_;     // local fine cells by their numbers in the whole mesh
  std::vector<Real> coordinates_;     // [parent, node, component]
  std::vector<Real> tips_;            // [parent, node] 1 at tips
};

}  // namespace sprekk::assembly
