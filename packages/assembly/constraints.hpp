// Prescribed values of unknowns, on boundaries and in regions.
#pragma once

#include "base/expression.hpp"
#include "contact/loose_pieces.hpp"
#include "fields/layout.hpp"
#include "mesh/mesh.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::assembly {

/// Values of a field on nodes or facets on a boundary, or of one on cells or facets in a region, per component; a
/// component without value is free. Facets in a region are those between two cells of which one is in it, or both where
/// a fracture is between them: fluxes through the boundary of the domain are left to conditions there.
struct DirichletCondition {
  std::string name;  ///< how messages call it
  std::string field;
  int boundary;  ///< number of the mesh's boundary; -1: all of the region
  std::vector<std::optional<base::Expression>> values;
  int region = -1;    ///< only on faces of cells of this region; -1: all
  int fracture = -1;  ///< only where this fracture ends; -1: on faces, and, if no region is named, where fractures end
  /// Of a field on nodes: only in this box, its lower and upper corner included.
  std::optional<std::array<std::array<Real, 3>, 2>> within = {};
  bool holds_at(const std::array<Real, 3>& x) const;
};

/// The unknowns that conditions on one node field hold.
struct Held {
  struct Entry {
    GlobalIndex unknown;  ///< free node * components + component, by the numbers of the mesh that it was found on
    int condition, component;
    std::array<Real, 3> x;
    std::array<Real, 3> side = {};  ///< from x into a face of its own side, where a fracture ends; see one_sided()
  };
  std::vector<Entry> entries;                   ///< one per unknown
  std::vector<std::pair<int, Entry>> repeated;  ///< (number of the first entry, a second condition on its unknown)
};

/// The values of the entries at time t. Where two conditions ask different values of one unknown, `conflicts` gets a
/// line that names both; one for each pair of conditions and component.
std::vector<Real> prescribed_values(const Held& held, const std::vector<DirichletCondition>& conditions, Real t,
                                    std::vector<std::string>& conflicts);

/// The conflicts at time t on a whole mesh, of conditions on the displacement. Not collective.
std::vector<std::string> find_conflicts(const mesh::GlobalMesh& mesh, const std::vector<DirichletCondition>& conditions,
                                        Real t);

/// All conditions on one node field: which owned unknowns they hold and to what value.
class Constraints {
 public:
  /// Boundary values are taken face by face at the nodes of the owning cell. Where a fracture ends on the boundary and
  /// a value jumps, each copy of the node has the value of its own side. `conditions` are those on this field.
  Constraints(const mesh::Mesh& mesh, const fields::Layout& layout, std::vector<DirichletCondition> conditions);

  /// Evaluates all values at time t. Throws an Error that names both conditions where two of them ask different values
  /// of one unknown. Local.
  void evaluate(Real t);

  const std::vector<DirichletCondition>& conditions() const { return conditions_; }
  const std::vector<Held::Entry>& entries() const { return held_.entries; }  ///< one per constrained owned unknown
  std::vector<contact::Support> supports() const;                            ///< the same, for contact
  ConstView<char*> mask() const { return mask_; }                            ///< [owned unknown] 1 if constrained
  ConstView<Real*> values() const { return values_; }  ///< [owned unknown] at the last evaluated time, else 0
  Real largest() const { return largest_; }            ///< largest |value| at the last evaluated time

 private:
  std::vector<DirichletCondition> conditions_;
  Held held_;  ///< owned
  View<char*> mask_;
  View<Real*> values_;
  Real largest_ = 0;
};

}  // namespace sprekk::assembly
