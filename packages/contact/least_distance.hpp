// The point of a polyhedron that is nearest to the origin.
#pragma once

#include "base/types.hpp"

#include <optional>
#include <vector>

namespace sprekk::contact {

/// min |y| with G y >= h, G [row][n], rows not zero; nothing, if no y satisfies it, or none was found in 10 times as
/// many iterations as there are rows and columns. To about 1e-12 where h / |row| is about 1.
/// C. L. Lawson, R. J. Hanson (1974), Solving Least Squares Problems, chapter 23, algorithms LDP and NNLS.
std::optional<std::vector<Real>> least_distance(std::vector<std::vector<Real>> G, std::vector<Real> h, int n);

}  // namespace sprekk::contact
