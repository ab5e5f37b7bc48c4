// Prescribed values of unknowns on boundaries.
#pragma once

#include "base/expression.hpp"
#include "fields/layout.hpp"
#include "mesh/mesh.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::assembly {

/// Values of a node field on a boundary, per component; a component without value is free.
struct DirichletCondition {
  std::string name;  ///< how messages call it
  std::string field;
  int boundary;  ///< number of the mesh's boundary
  std::vector<std::optional<base::Expression>> values;
  int region = -1;  ///< only on faces of cells of this region; -1: all
};

/// All conditions on one node field: which owned unknowns they hold and to what value.
class Constraints {
 public:
  struct Entry {
    LocalIndex unknown;
    int condition, component;
    std::array<Real, 3> x;
  };

  /// Boundary values are taken face by face at the nodes of the owning cell. `conditions` are those on this field.
  Constraints(const mesh::Mesh& mesh, const fields::Layout& layout, std::vector<DirichletCondition> conditions);

  /// Evaluates all values at time t. Throws an Error that names both conditions where two of them ask different values
  /// of one unknown. Local.
  void evaluate(Real t);

  const std::vector<DirichletCondition>& conditions() const { return conditions_; }
  const std::vector<Entry>& entries() const { return entries_; }  ///< one per constrained owned unknown
  ConstView<char*> mask() const { return mask_; }                 ///< [owned unknown] 1 if constrained
  ConstView<Real*> values() const { return values_; }  ///< [owned unknown] at the last evaluated time, else 0
  Real largest() const { return largest_; }            ///< largest |value| at the last evaluated time

 private:
  Real value(const Entry& entry, Real t) const;

  std::vector<DirichletCondition> conditions_;
  std::vector<Entry> entries_;
  std::vector<std::pair<int, Entry>> repeated_;  ///< (number of the first entry, a second condition on its unknown)
  View<char*> mask_;
  View<Real*> values_;
  Real largest_ = 0;
};

}  // namespace sprekk::assembly
