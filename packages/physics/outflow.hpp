// What leaves through boundaries where a flux is prescribed.
#pragma once

#include "assembly/load.hpp"
#include "assembly/module.hpp"
#include "base/expression.hpp"
#include "physics/exchange.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::physics {

struct BoundaryCondition;
struct Scene;

/// What leaves through a boundary per area and time: the value; or with a coefficient c as much as c (u - value), see
/// Exchange, the value being that beyond the boundary.
struct FluxCondition {
  int boundary;
  base::Expression value;
  std::optional<base::Expression> coefficient = {};
  int region = -1;    ///< only on faces of cells of this region; -1: all
  int fracture = -1;  ///< through the end of this fracture, of which the area is length times aperture; -1: of rock
};

/// The entries of a boundary condition that make a FluxCondition: a flux, or a coefficient and the value beyond.
struct FluxEntries {
  std::optional<base::Expression> BoundaryCondition::*flux, BoundaryCondition::*beyond, BoundaryCondition::*coefficient;
};

/// Those of a scene that hold for rock, or for ends of fractures.
std::vector<FluxCondition> flux_conditions(const Scene& scene, const mesh::Mesh& mesh, const FluxEntries& entries,
                                           bool of_fractures = false);

struct OutflowNames {
  std::string coefficient;  ///< its entry in a scene
  std::string inflows;      ///< what flows in, in results.json
  std::string unit;         ///< of that
};

/// Adds what leaves by conditions to the rows of a field.
class Outflow {
 public:
  Outflow(std::vector<FluxCondition> conditions, OutflowNames names)
      : conditions_(std::move(conditions)), names_(std::move(names)) {}

  const std::vector<FluxCondition>& conditions() const { return conditions_; }
  bool constant_in_time() const;
  /// A point x of the boundary with the condition, the area for which it stands, and the facet's row. Throws an Error
  /// where the coefficient is below zero.
  void add(std::size_t condition, LocalIndex row, Real area, const std::array<Real, 3>& x);
  /// Once all are added.
  void bind(const assembly::Context& context, int block, const laws::Fluid& fluid);
  /// Moves on to time t, and adds what is prescribed to a load on the host, [owned row].
  template <class Host>
  void set_time(Real t, const Host& load) {
    std::vector<Real> beyond;
    for (const auto& point : points_) {
      const Real value = conditions_[point.condition].value(point.x, t);
      if (conditions_[point.condition].coefficient)
        beyond.push_back(value);
      else if (point.row < n_owned_)
        load(point.row) += point.area * value;
    }
    exchange_.set_outside(beyond);
  }
  void add_residual(const assembly::State& state, const assembly::Rows& r) const { exchange_.add_residual(state, r); }
  void add_jacobian(const assembly::State& state, fields::BlockMatrix& J) const { exchange_.add_jacobian(state, J); }
  /// The largest value on this rank, of a flux or of what is beyond.
  Real largest(Real t, bool beyond) const;
  /// Appends the rates into the domain for each condition, by boundaries: of those with a coefficient such that the
  /// rows of the last step are in balance.
  void totals(const assembly::State& state, const mesh::Mesh& mesh, std::vector<assembly::Total>& totals) const;

 private:
  struct Point {
    std::size_t condition;
    LocalIndex row;
    Real area;
    std::array<Real, 3> x;
  };

  std::vector<FluxCondition> conditions_;
  OutflowNames names_;
  std::map<LocalIndex, Real> unbalanced_per_coefficient(const assembly::State& state) const;

  std::vector<Point> points_;
  int block_ = -1;
  LocalIndex n_owned_ = 0;
  laws::Fluid fluid_;
  Exchange exchange_;  // with what is beyond
};

}  // namespace sprekk::physics
