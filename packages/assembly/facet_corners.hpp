// Values at corners as a coarse space of a field on facets, for multigrid.
#pragma once

#include "fields/layout.hpp"

namespace sprekk::assembly {

/// Interpolation to facets from unknowns at corners, and the positions of these, [owned unknown, dim], m.
struct FacetCorners {
  RCP<const fields::CrsMatrix> interpolation;
  RCP<const fields::MultiVector> places;
};

/// Returns the interpolation for a field with one component on facets. The value of a facet is the mean over its
/// corners; ridges in 2D are corners themselves. The unknowns are separate on both sides of a fracture and in the
/// fracture. Fractures share them where they are joined by a common ridge, and have their own ones where they only
/// touch in a point. Numbers ascend with the ranks. Collective.
FacetCorners facet_corners(const mesh::Mesh& mesh, const fields::Layout& layout);

}  // namespace sprekk::assembly
