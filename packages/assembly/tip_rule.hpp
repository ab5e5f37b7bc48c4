// Quadrature for functions of the square root of the distance from some corners of a cell or face.
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

/// Quadrature rules for functions that are smooth in s = sqrt(rho). rho is the sum of the shape functions of all
/// corners that are not tips. The reference cell has order 1; tip_rule_of_edge is for the reference edge [0, 1]. The
/// cell is cut into simplices around a tip; the mean over several possible tips is taken. In each simplex, rho = s^2 is
/// the coordinate from its tips to its other corners. The rule is a product of n Gauss points in s and in each
/// transverse direction. It is exact for polynomials of degree < 2 n in s and in the transverse directions.
///   tips: [corner] 1 for a tip; at least one corner is a tip and one is not.
std::vector<RulePoint> tip_rule(mesh::Shape shape, const std::vector<char>& tips, int n);
std::vector<RulePoint> tip_rule_of_edge(const std::vector<char>& tips, int n);

/// Cache of rules, by cell shape and tip corners.
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
