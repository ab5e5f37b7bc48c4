// Prescribed values of unknowns on boundaries and in regions.
#pragma once

#include "base/expression.hpp"
#include "contact/floating_pieces.hpp"
#include "fields/layout.hpp"
#include "mesh/mesh.hpp"

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::assembly {

/// Dirichlet condition on one field. A component without a value is free. The condition applies either to nodes or
/// facets on a boundary, to cells or facets in a region, or to facets of a fracture in a box. A facet is in a region if
/// one of its two cells is in this region. On a fracture, both cells must be. Facets on the domain boundary are
/// excluded: boundary conditions prescribe their fluxes. A face or ridge of a fracture is in a box if all of its
/// corners are.
struct DirichletCondition {
  std::string name;  ///< name in messages
  std::string field;
  int boundary;  ///< number of the boundary in the mesh; -1: everywhere in the region, or in `within` on the fracture
  std::vector<std::optional<base::Expression>> values;
  int region = -1;    ///< restriction to faces of cells of this region; -1: all
  int fracture = -1;  ///< restriction to the ends of this fracture; -1: faces, and fracture ends if no region is given
  /// Box that restricts the condition, lower and upper corner included. For fields on nodes, and on fractures.
  std::optional<std::array<std::array<Real, 3>, 2>> within = {};
  bool applies_at(const std::array<Real, 3>& x) const;
};

/// Calls visit(facet, centre) for the faces and ridges of local fracture faces to which a condition on a fracture in a
/// box applies.
void for_each_facet_on_fracture(const mesh::Mesh& mesh, const DirichletCondition& condition,
                                const std::function<void(LocalIndex, const std::array<Real, 3>&)>& visit);

/// Unknowns of one field that conditions prescribe.
struct Constrained {
  struct Entry {
    GlobalIndex unknown;  ///< entity * components + component; entity: free node, cell, facet or enriched node
    int condition, component;
    std::array<Real, 3> x;
    std::array<Real, 3> side = {};  ///< from x into a face on the node's side, at ends of fractures; see one_sided()
  };
  std::vector<Entry> entries;                   ///< one per unknown
  std::vector<std::pair<int, Entry>> repeated;  ///< (number of the first entry, second condition on its unknown)
};

/// Returns the values of the entries at time t. If two conditions prescribe different values of one unknown, a message
/// with both is appended to `conflicts`, one per pair of conditions and component. Throws an Error where an expression
/// has no value.
std::vector<Real> prescribed_values(const Constrained& constrained, const std::vector<DirichletCondition>& conditions,
                                    Real t, std::vector<std::string>& conflicts);

/// Returns the conflicts at time t of conditions on a field, on a whole mesh. Not collective.
std::vector<std::string> find_conflicts(const mesh::GlobalMesh& mesh, const std::vector<DirichletCondition>& conditions,
                                        Real t);

/// Conditions on one field: the owned unknowns they prescribe, and the values.
class Constraints {
 public:
  /// Finds the prescribed unknowns. Boundary conditions apply to the nodes of boundary faces. If a value is
  /// discontinuous where a fracture ends on the boundary, each copy of the node has the value of its own side.
  /// `conditions` must be those on this field.
  Constraints(const mesh::Mesh& mesh, const fields::Layout& layout, std::vector<DirichletCondition> conditions);

  /// Evaluates all values at time t. Throws an Error with the names of both conditions if two prescribe different
  /// values of one unknown. Local.
  void evaluate(Real t);

  const std::vector<DirichletCondition>& conditions() const { return conditions_; }
  /// One per constrained owned unknown.
  const std::vector<Constrained::Entry>& entries() const { return constrained_.entries; }
  std::vector<contact::Support> supports() const;      ///< constrained unknowns, for contact
  ConstView<char*> mask() const { return mask_; }      ///< [owned unknown] 1 if constrained
  ConstView<Real*> values() const { return values_; }  ///< [owned unknown] at the last evaluated time; 0 if free
  Real largest() const { return largest_; }            ///< largest |value| at the last evaluated time

 private:
  std::vector<DirichletCondition> conditions_;
  Constrained constrained_;  ///< owned unknowns only
  View<char*> mask_;
  View<Real*> values_;
  Real largest_ = 0;
};

}  // namespace sprekk::assembly
