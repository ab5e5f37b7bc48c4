// Mixed-dimensional domain: bulk of dimension d, fractures (d - 1), intersections of fractures (d - 2), and in 3D
// common points of intersections (d - 3). It contains the interfaces between neighbours and the projections across
// them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// Edge (2D: corner) of a fracture face. Ridges are numbered in the order of their first occurrence in fracture_faces.
struct Ridge {
  /// Face at the ridge. The ridge starts at the given corner of the face, as numbered from its minus cell.
  struct Face {
    GlobalIndex face;  ///< index into fracture_faces
    int corner;
  };
  std::array<GlobalIndex, 2> nodes;  ///< parent nodes of the ends, in the direction of the first face; 2D: second is -1
  std::vector<Face> faces;           ///< ascending
};

/// Connected part of the domain of one dimension.
struct Subdomain {
  std::string name;  ///< "bulk", name of the fracture, or of an intersection: "a*b"; if repeated "a*b#2"
  int dimension;
  std::vector<int> fractures;      ///< fractures at this part, ascending; empty for the bulk
  std::vector<GlobalIndex> cells;  ///< [cell] cell, fracture face or ridge of the mesh; parent node for a point in 3D
  std::vector<Real> measures;      ///< [cell] volume, area, length; metre^dimension, 1 for points

  GlobalIndex n_cells() const { return static_cast<GlobalIndex>(cells.size()); }
  Real measure() const;  ///< sum over the cells
};

/// Sparse matrix: y[to] = sum of weight * x[from] over the entries.
struct Map {
  struct Entry {
    GlobalIndex to, from;
    Real weight;
  };
  GlobalIndex n_to, n_from;
  std::vector<Entry> entries;

  std::vector<Real> operator()(const std::vector<Real>& x) const;
};

/// Transfers one value per cell from one side of an interface to the other.
struct Projection {
  Map average;    ///< for values: mean weighted by the shared measure; rows sum to 1, so constants are preserved
  Map integrate;  ///< for integrals over cells: distribution by measure; columns sum to 1, so the total is preserved
};

/// Interface between a subdomain and one of the next lower dimension. Its cells are facets: parts of the boundary of
/// the higher-dimensional subdomain on the lower-dimensional one. Each facet coincides with one lower-dimensional cell.
/// This cell has one facet per side of the bulk, or one per face of a fracture (edge of a line) that ends there. The
/// higher-dimensional value at facet f is that of cell facets[f].cell.
struct Interface {
  struct Facet {
    GlobalIndex cell;  ///< index into the cells of the higher-dimensional subdomain
    int local;         ///< bulk: face of the cell; fracture: first corner of the ridge; line: end of the edge
  };
  int higher, lower;         ///< indices into subdomains
  std::optional<Side> side;  ///< side of the fracture next to the bulk; none at intersections and points
  std::vector<Facet> facets;
  std::vector<Real> measures;  ///< [facet]
  Projection to_lower;         ///< from facets to the lower-dimensional cells
  Projection to_higher;        ///< from the lower-dimensional cells to facets
};

struct Hierarchy {
  /// By descending dimension: bulk, fractures in their order, then lower dimensions by their sets of fractures.
  std::vector<Subdomain> subdomains;
  std::vector<Interface> interfaces;  ///< by lower-dimensional subdomain, then by higher-dimensional one, then by side
  std::vector<Ridge> ridges;          ///< of all fracture faces
  std::vector<std::vector<GlobalIndex>> tips;  ///< [fracture] ridges with one face, not on the domain boundary

  /// Number of subdomains of the given dimension.
  int count(int dimension) const;
};

/// Makes the hierarchy of a split mesh. Not collective.
///
/// An intersection is a set of ridges with the same two or more fractures, in 3D connected through common nodes.
/// Crossings (X), abutments (T) and contacts at tips (L, Y) are intersections. At the common point of three planes,
/// three lines cross. A point in 3D is a node with edges of different lines. Ridges of one fracture only are no
/// intersections, nor are fractures in 3D that share a node but no edge. Names, counts, and all orders except that of
/// the bulk cells are independent of the numbers of nodes and cells. Throws an Error if the mesh has fracture faces but
/// no parent_node.
Hierarchy make_hierarchy(const GlobalMesh& mesh);

}  // namespace sprekk::mesh
