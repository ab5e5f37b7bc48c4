// Nearest point of a polyhedron to the origin.
#pragma once

#include "base/types.hpp"

#include <optional>
#include <vector>

namespace sprekk::contact {

/// Returns y with the smallest |y| that satisfies G y >= h. G: [row][n], rows must not be zero. No value: no solution,
/// or none found in 10 times as many iterations as rows and columns. The accuracy is about 1e-12 if h / |row| is about
/// 1. Source: C. L. Lawson, R. J. Hanson (1974), Solving Least Squares Problems, chapter 23, algorithms LDP and NNLS.
std::optional<std::vector<Real>> least_distance(std::vector<std::vector<Real>> G, std::vector<Real> h, int n);

}  // namespace sprekk::contact
