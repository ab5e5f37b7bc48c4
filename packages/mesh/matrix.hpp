// Matrices of three rows.
#pragma once

#include "mesh/facets.hpp"

#include <array>

namespace sprekk::mesh {

using Matrix = std::array<Vector, 3>;  ///< [row][column]

inline Real product(const Matrix& A, const Matrix& B) { return dot(A[0], B[0]) + dot(A[1], B[1]) + dot(A[2], B[2]); }
inline Vector times(const Matrix& A, const Vector& v) { return {dot(A[0], v), dot(A[1], v), dot(A[2], v)}; }
/// Returns A^T v.
inline Vector transposed_times(const Matrix& A, const Vector& v) { return v[0] * A[0] + v[1] * A[1] + v[2] * A[2]; }
inline Real trace(const Matrix& A) { return A[0][0] + A[1][1] + A[2][2]; }

}  // namespace sprekk::mesh
