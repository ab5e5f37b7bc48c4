// First fracture on a straight line, in 2D.
#pragma once

#include "mesh/facets.hpp"

#include <optional>

namespace sprekk::mesh {

/// Fracture face on the line from a point.
struct FaceAhead {
  int single = -1;       ///< single fracture
  Vector along{};        ///< unit vector along the face, to the left of the line
  LocalIndex face = -1;  ///< owned face, on the rank of the face; -1 on other ranks
  LocalIndex cell = -1;  ///< owned cell beyond the face, on its rank; -1 on other ranks
};

/// Returns the first face on the line from x along a unit vector that does not belong to the single fracture `except`;
/// none: no fracture is ahead. Collective.
std::optional<FaceAhead> first_face_ahead(const Mesh& mesh, const Vector& x, const Vector& direction, int except);

}  // namespace sprekk::mesh
