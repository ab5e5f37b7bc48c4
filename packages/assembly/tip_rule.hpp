// Quadrature of functions that behave like the root of the distance to some corners of a cell or face.
#pragma once

#include "base/types.hpp"
#include "mesh/shape.hpp"

#include <array>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace sprekk::assembly {

struct RulePoint {
  std::array<Real, 3> xi;  ///< reference point
  Real weight;             ///< on the reference cell
};

/// A rule for a reference cell of order 1, or for a reference edge [0, 1] where `shape` is absent, whose functions are
/// smooth in s = sqrt(rho), rho the sum of the node functions of all corners but the tips. The cell is cut into
/// simplices around a tip (the mean is taken where several tips will do); in each, rho = s^2 is the coordinate from its
/// tips to its other corners, and Gauss points with n in each direction do the rest. Exact for polynomials of degree <
/// 2 n in s and in directions across.
///   tips: [corner] 1 for a tip; at least one is and one is not.
std::vector<RulePoint> tip_rule(mesh::Shape shape, const std::vector<char>& tips, int n);
std::vector<RulePoint> tip_rule_of_edge(const std::vector<char>& tips, int n);

/// Rules that were asked for before: those of the few ways in which cells and faces have tips.
class TipRules {
 public:
  using Rule = std::vector<RulePoint>;
  const Rule& of(mesh::Shape shape, const std::vector<char>& tips, int n);
  const Rule& of_edge(const std::vector<char>& tips, int n);

 private:
  std::map<std::tuple<mesh::Shape, std::vector<char>, int>, Rule> rules_;
  std::map<std::pair<std::vector<char>, int>, Rule> edges_;
};

}  // namespace sprekk::assembly
