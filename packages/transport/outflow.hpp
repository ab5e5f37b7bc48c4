// Outflow through boundaries with a prescribed flux.
#pragma once

#include "assembly/load.hpp"
#include "assembly/module.hpp"
#include "base/expression.hpp"
#include "transport/exchange.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::transport {

/// Prescribed outflow per area and time: the value, or c (u - value) with a coefficient c, see Exchange. In the second
/// case the value is that of u outside.
struct FluxCondition {
  int boundary;
  base::Expression value;
  std::optional<base::Expression> coefficient = {};
  int region = -1;            ///< only faces of cells of this region; -1: all
  int fracture = -1;          ///< only ends of this fracture, with the area length times aperture; -1: rock
  std::string location = "";  ///< of its section in the scene, for errors
};

struct OutflowNames {
  std::string coefficient;  ///< name of its entry in a scene
  std::string inflows;      ///< name of the inflow in results.json
  std::string unit;         ///< unit of the inflow
};

/// Adds the outflow of flux conditions to the rows of a field.
class Outflow {
 public:
  Outflow(std::vector<FluxCondition> conditions, OutflowNames names)
      : conditions_(std::move(conditions)), names_(std::move(names)) {}

  const std::vector<FluxCondition>& conditions() const { return conditions_; }
  bool constant_in_time() const;
  /// Adds a boundary point x with the area that it represents and the row of its facet. Throws an Error if the
  /// coefficient is negative.
  void add(std::size_t condition, LocalIndex row, Real area, const std::array<Real, 3>& x);
  /// Completes the set-up after all points have been added.
  void bind(const assembly::Context& context, int block, const laws::Fluid& fluid);
  /// Sets the time t. Adds the prescribed outflows to a load on the host, [owned row].
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
  /// Largest absolute value on this rank, of fluxes or of exterior values.
  Real largest(Real t, bool beyond) const;
  /// Appends the inflow rate of each condition, named by its boundary. Rates with a coefficient are corrected so that
  /// the rows of the last step are balanced.
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
  Exchange exchange_;  // with the exterior
};

}  // namespace sprekk::transport
