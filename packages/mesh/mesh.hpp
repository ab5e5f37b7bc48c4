// Mixed-dimensional mesh: cells, fracture faces with two sides, boundary faces. The data lie on the host and do not
// change after construction.
#pragma once

#include "base/types.hpp"
#include "mesh/shape.hpp"

#include <array>
#include <map>
#include <string>
#include <vector>

namespace sprekk::mesh {

enum Side { minus = 0, plus = 1 };

/// Single fracture of a set: a trace, a polygon or an ellipse of a network. A set consists of all fracture faces with
/// one name in the scene. In a box, or a mesh file without a list of single fractures, each set is one single fracture.
struct SingleFracture {
  std::string name;
  int set;                                             ///< index into fracture_names
  std::map<std::string, std::string> properties = {};  ///< material entries of this fracture only, as text
};

/// Whole mesh, identical on every rank that stores it. Nodes are already split along the fractures.
struct GlobalMesh {
  struct FractureFace {
    int fracture;                     ///< index into fracture_names
    std::array<GlobalIndex, 2> cell;  ///< cells on side minus and plus; the normal points from minus to plus
    std::array<int, 2> local_face;    ///< number of the face in each cell
    int single = 0;                   ///< index into single_fractures
  };
  struct BoundaryFace {
    int boundary;  ///< index into boundary_names
    GlobalIndex cell;
    int local_face;
  };

  Shape shape;
  std::vector<Real> coordinates;         ///< [node * dim + component], metre
  std::vector<GlobalIndex> cells;        ///< [cell * n_nodes(shape) + local node]
  std::vector<int> cell_region;          ///< [cell], index into region_names
  std::vector<GlobalIndex> parent_node;  ///< [node] original of a copied node, else the node itself; see split.hpp
  std::vector<GlobalIndex> tied_to;      ///< [tied node] node with the same unknowns; see periodic.hpp
  std::vector<FractureFace> fracture_faces;
  std::vector<BoundaryFace> boundary_faces;
  std::vector<std::string> region_names, boundary_names, fracture_names;
  std::vector<SingleFracture> single_fractures = {};  ///< ordered by set
  /// [node] 1 at crack tips with a square-root field, otherwise 0; empty without such tips. Order 1
  /// represents this field by additional unknowns (see mark_tips()), order 2 by quarter-point nodes.
  std::vector<char> tip = {};

  /// Number of nodes with their own unknowns; these nodes come first.
  GlobalIndex n_free_nodes() const { return n_nodes() - static_cast<GlobalIndex>(tied_to.size()); }
  GlobalIndex free_node(GlobalIndex node) const {
    return node < n_free_nodes() ? node : tied_to[node - n_free_nodes()];
  }
  /// Number of the geometric point at a node, identical for all copies of the node.
  GlobalIndex point_of(GlobalIndex node) const {
    return parent_node.empty() ? free_node(node) : parent_node[free_node(node)];
  }
  int dim() const { return dimension(shape); }
  GlobalIndex n_cells() const { return static_cast<GlobalIndex>(cell_region.size()); }
  GlobalIndex n_nodes() const { return static_cast<GlobalIndex>(coordinates.size()) / dim(); }
};

/// Quality of a partition.
struct PartitionReport {
  std::array<GlobalIndex, 2> cells, fracture_faces;  ///< minimum and maximum per part; a face counts at its minus cell
  double cell_imbalance;                             ///< largest number of cells in a part / mean; 1 is perfect
  double fracture_face_imbalance;                    ///< same ratio for fracture faces; 1 without fracture faces
  GlobalIndex edge_cut;         ///< pairs of adjacent cells in different parts, also across fractures
  GlobalIndex separated_faces;  ///< fracture faces whose two cells are in different parts
};

/// Facets of cells and of fracture faces, numbered as separate entities.
/// * Cell facets: one between two adjacent cells, one per boundary face. A fracture face is one facet, common to the
///   cells on its two sides.
/// * Ridges of fracture faces (points in 2D, edges in 3D): one per geometric ridge, common to the faces of all
///   fractures at it.
///
/// A facet belongs to the owner of the adjacent cell, or fracture face, with the lowest number. A fracture face as a
/// facet belongs to the owner of the face.
///
/// Facets of fractures alone (`in_rock` false) are fracture faces and ridges.
struct Facets {
  /// Ridge of a fracture face on the boundary of the domain.
  struct Rim {
    LocalIndex face;  ///< local fracture face with its cell on side minus
    int ridge;        ///< number of the ridge in the face
    int boundary;
  };
  std::vector<GlobalIndex> id;            ///< [facet] global number, independent of the partition; owned facets first
  std::vector<LocalIndex> of_cell;        ///< [cell * n_faces(shape) + local face] facet; -1: none
  std::vector<LocalIndex> fracture_face;  ///< [fracture face] facet
  std::vector<LocalIndex> ridge;  ///< [fracture face * n_face_corners(shape) + k] facet; ridge k: see ridge_points()
  std::vector<Rim> rims;
  LocalIndex n_owned = 0;
  bool in_rock = true;  ///< faces of cells off fractures are facets
};

/// Part of the mesh on one rank. Owned entities come first in every list, ghosts follow. Counts "n_..." include ghosts,
/// counts "n_owned_..." do not.
///
/// Owners:
/// * cell: the rank given by the partition;
/// * fracture face: the owner of its minus cell;
/// * node: the lowest rank that owns a cell at the node.
///
/// Ghost cells:
/// * all cells that share a node with an owned cell;
/// * the cell on the opposite side of every owned fracture face;
/// * the minus cells of all fracture faces that share a corner point with an owned face, also of other fractures.
///
/// Local nodes are the nodes of all local cells. Local fracture faces have at least one local cell. With these ghosts,
/// the rows of owned nodes and facets are assembled from local cells and faces without communication.
struct Mesh {
  struct FractureFace {
    GlobalIndex id;                  ///< global number
    int fracture;                    ///< index into fracture_names
    int single;                      ///< index into single_fractures
    std::array<LocalIndex, 2> cell;  ///< local cells on side minus and plus; -1 if not on this rank
    std::array<int, 2> local_face;   ///< number of the face in each cell
    std::array<std::array<LocalIndex, max_face_nodes>, 2>
        nodes;  ///< local nodes of each side, coincident for equal k; -1 if absent
    std::array<GlobalIndex, 4>
        corners;  ///< global numbers of the points at the corners, equal for all faces at a point
    Real area;    ///< area, m^2 (2D: length, m)
    std::array<Real, 3> centre;
    std::array<std::array<Real, 3>, 3>
        frame;  ///< rows n, t1[, t2]; 2D t = (n_y, -n_x); 3D t1 = a x n/|a x n|, t2 = n x t1; a: see face_frame()
  };
  struct BoundaryFace {
    int boundary;
    LocalIndex cell;
    int local_face;
    bool owned;  ///< this rank owns the cell
  };

  RCP<const Comm> comm;
  Shape shape;
  LocalIndex n_owned_nodes = 0, n_owned_cells = 0, n_owned_fracture_faces = 0;
  LocalIndex n_free_nodes = 0;      ///< nodes with their own unknowns, owned and ghosts; tied nodes follow
  std::vector<LocalIndex> tied_to;  ///< [tied node] local node with the same unknowns
  std::vector<GlobalIndex> node_id, cell_id;
  std::vector<int> cell_owner;    ///< [cell] rank
  std::vector<Real> coordinates;  ///< [node * dim + component], metre
  std::vector<LocalIndex> cells;  ///< [cell * nodes per cell + local node]
  std::vector<int> cell_region;   ///< [cell]
  std::vector<int> cell_piece;    ///< [cell] piece of rock between the fractures
  std::vector<FractureFace> fracture_faces;
  std::vector<BoundaryFace> boundary_faces;  ///< of all local cells
  std::vector<std::string> region_names, boundary_names, fracture_names;
  std::vector<SingleFracture> single_fractures;  ///< of the whole mesh, on every rank
  GlobalIndex n_global_nodes = 0, n_global_cells = 0, n_global_fracture_faces = 0;
  int n_pieces = 0;       ///< see find_pieces()
  std::vector<char> tip;  ///< [node] see GlobalMesh; empty without marked tips
  /// Enriched nodes: nodes that are not tips but belong to a cell with a tip. They have additional unknowns and a
  /// separate numbering, owned nodes first.
  std::vector<LocalIndex> enriched;      ///< [node] number among the enriched nodes, or -1; empty without tips
  std::vector<GlobalIndex> enriched_id;  ///< [enriched node] global number
  LocalIndex n_owned_enriched = 0;
  GlobalIndex n_global_enriched = 0;
  PartitionReport partition{};  ///< of the whole mesh
  RCP<const Facets> facets;     ///< null if no field has unknowns on facets; see with_facets()
  /// Numbers of the local entities in the whole mesh, if this mesh is a part of it; see without_regions().
  struct Origin {
    std::vector<GlobalIndex> nodes, cells, fracture_faces, enriched, facets;
  };
  RCP<const Origin> origin;  ///< null for a whole mesh

  int dim() const { return dimension(shape); }
  int nodes_per_cell() const { return mesh::n_nodes(shape); }
  LocalIndex n_nodes() const { return static_cast<LocalIndex>(node_id.size()); }
  LocalIndex free_node(LocalIndex node) const { return node < n_free_nodes ? node : tied_to[node - n_free_nodes]; }
  LocalIndex n_cells() const { return static_cast<LocalIndex>(cell_id.size()); }
  LocalIndex n_fracture_faces() const { return static_cast<LocalIndex>(fracture_faces.size()); }
};

}  // namespace sprekk::mesh
