// The mixed-dimensional domain: bulk (dimension d), fractures (d - 1), their intersections (d - 2), and in 3D the
// points (d - 3) where intersections meet; with the interfaces between neighbours and the projections across them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// An edge (2D: a corner) of a fracture face. Ridges are numbered as one meets them walking along fracture_faces.
struct Ridge {
  /// One of the faces around the ridge, which starts at this corner of it, as seen from its minus cell.
  struct Face {
    GlobalIndex face;  ///< index into fracture_faces
    int corner;
  };
  std::array<GlobalIndex, 2>
      nodes;                ///< parent nodes of its ends, as the first face runs through them; 2D: the second is -1
  std::vector<Face> faces;  ///< ascending
};

/// One part of the domain: all cells of one dimension that belong together.
struct Subdomain {
  std::string
      name;  ///< "bulk", the fracture's, or of the fractures that meet: "a*b", the next of the same name "a*b#2"
  int dimension;
  std::vector<int> fractures;      ///< that meet here, ascending; empty for the bulk
  std::vector<GlobalIndex> cells;  ///< [cell] cell, fracture face or ridge of the mesh; parent node for a point in 3D
  std::vector<Real> measures;      ///< [cell] volume, area, length; metre^dimension, 1 for points

  GlobalIndex n_cells() const { return static_cast<GlobalIndex>(cells.size()); }
  Real measure() const;  ///< sum of the cells'
};

/// A sparse matrix: y[to] = sum of weight * x[from] over its entries.
struct Map {
  struct Entry {
    GlobalIndex to, from;
    Real weight;
  };
  GlobalIndex n_to, n_from;
  std::vector<Entry> entries;

  std::vector<Real> operator()(const std::vector<Real>& x) const;
};

/// Takes one value per cell from one side of an interface to the other.
struct Projection {
  Map average;    ///< of values: the mean weighted with the shared measure; each row sums to one, so constants stay
  Map integrate;  ///< of integrals over cells: shares them out by measure; each column sums to one, so the total stays
};

/// Where a subdomain touches one of a dimension lower. Its cells are the facets: the parts of the higher-dimensional
/// subdomain's boundary that lie on the lower-dimensional one. Each facet coincides with one cell of the latter, which
/// has one facet on either side of the bulk, and in a fracture (line) one for each face (edge) that ends there.
/// A value in the higher-dimensional subdomain reaches facet f as that of cell facets[f].cell.
struct Interface {
  struct Facet {
    GlobalIndex cell;  ///< of the higher-dimensional subdomain, index into its cells
    int local;  ///< face of the bulk's cell, first corner of the ridge in the fracture's face, end of the line's edge
  };
  int higher, lower;         ///< indices into subdomains
  std::optional<Side> side;  ///< of the fracture, towards the bulk; none at intersections and points
  std::vector<Facet> facets;
  std::vector<Real> measures;  ///< [facet]
  Projection to_lower;         ///< from facets to the lower-dimensional subdomain's cells
  Projection to_higher;        ///< back
};

struct Hierarchy {
  /// By descending dimension: the bulk, the fractures in their order, the others by the fractures that meet there.
  std::vector<Subdomain> subdomains;
  std::vector<Interface> interfaces;  ///< by lower-dimensional subdomain, then by higher-dimensional one, then by side
  std::vector<Ridge> ridges;          ///< of all fracture faces
  std::vector<std::vector<GlobalIndex>> tips;  ///< [fracture] ridges with one face only, not on the domain's boundary

  /// Number of subdomains of a dimension.
  int count(int dimension) const;
};

/// The hierarchy of a split mesh.
///
/// An intersection is a set of ridges in which the same two or more fractures meet, in 3D connected through common
/// nodes: crossings (X), abutments (T), and meetings at tips (L, Y) alike. Where three planes cross, three lines go
/// through the point. A point in 3D is a node where edges of different lines meet. Meetings of faces of one fracture
/// only, and of fractures that share a node but no edge in 3D, are no intersections.
/// Names, counts, and all orders except that of the bulk's cells do not depend on the numbering of nodes and cells.
/// Throws an Error if the mesh has fracture faces but no parent_node.
Hierarchy make_hierarchy(const GlobalMesh& mesh);

}  // namespace sprekk::mesh
