// The mixed-dimensional mesh: cells, fracture faces with two sides, boundary faces. Plain host data, filled once.
#pragma once

#include "base/types.hpp"
#include "mesh/shape.hpp"

#include <array>
#include <map>
#include <string>
#include <vector>

namespace sprekk::mesh {

enum Side { minus = 0, plus = 1 };

/// One fracture of a set: a trace, a polygon or an ellipse of a network. All faces that a scene calls by one name are a
/// set; of a box, and of a file that does not tell more, each set is one fracture.
struct SingleFracture {
  std::string name;
  int set;                                             ///< index into fracture_names
  std::map<std::string, std::string> properties = {};  ///< entries of a material that it has of its own, as texts
};

/// The whole mesh, the same on every rank that holds it. Nodes are already split along the fractures.
struct GlobalMesh {
  struct FractureFace {
    int fracture;                     ///< index into fracture_names
    std::array<GlobalIndex, 2> cell;  ///< the cell on side minus, plus; the normal points from minus to plus
    std::array<int, 2> local_face;    ///< the face's number in that cell
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
  std::vector<GlobalIndex> parent_node;  ///< [node] the node that split() copied, itself for all others; see split.hpp
  std::vector<GlobalIndex>
      tied_to;  ///< the node that each of the last nodes shares its unknowns with; see periodic.hpp
  std::vector<FractureFace> fracture_faces;
  std::vector<BoundaryFace> boundary_faces;
  std::vector<std::string> region_names, boundary_names, fracture_names;
  std::vector<SingleFracture> single_fractures = {};  ///< those of a set follow each other, sets in their order
  /// [node] 1 for crack tips around which displacements follow the root of the distance: by further unknowns at order 1
  /// (see mark_tips()), by quarter points at order 2; empty: nowhere.
  std::vector<char> tip = {};

  /// Nodes with unknowns of their own come first.
  GlobalIndex n_free_nodes() const { return n_nodes() - static_cast<GlobalIndex>(tied_to.size()); }
  GlobalIndex free_node(GlobalIndex node) const {
    return node < n_free_nodes() ? node : tied_to[node - n_free_nodes()];
  }
  /// The number of the point at a node, the same for all its copies.
  GlobalIndex point_of(GlobalIndex node) const {
    return parent_node.empty() ? free_node(node) : parent_node[free_node(node)];
  }
  int dim() const { return dimension(shape); }
  GlobalIndex n_cells() const { return static_cast<GlobalIndex>(cell_region.size()); }
  GlobalIndex n_nodes() const { return static_cast<GlobalIndex>(coordinates.size()) / dim(); }
};

/// How good a partition is.
struct PartitionReport {
  std::array<GlobalIndex, 2> cells, fracture_faces;  ///< fewest and most in a part; faces count at their minus cell
  double cell_imbalance;                             ///< most cells in a part / mean over all parts; 1 is perfect
  double fracture_face_imbalance;                    ///< the same of fracture faces; 1 where there are none
  GlobalIndex edge_cut;         ///< pairs of cells that share a face, or a fracture face, and are in different parts
  GlobalIndex separated_faces;  ///< fracture faces whose two cells are in different parts
};

/// What cells and fracture faces end in, as entities of their own. Of cells: one between two of them, the fracture face
/// itself for the two beside it, one on the boundary. Of fracture faces (ridges: points in 2D, edges in 3D): one for
/// all faces, of any fracture, that end there. A facet belongs to the rank of that one of its cells, or faces, that has
/// the lowest number; a fracture face as a facet to its own.
struct Facets {
  /// Where a fracture face ends on the boundary.
  struct Rim {
    LocalIndex face;  ///< local fracture face with its cell on side minus
    int ridge;        ///< which of its ridges
    int boundary;
  };
  std::vector<GlobalIndex> id;            ///< [facet] global number, the same for any partition; owned ones first
  std::vector<LocalIndex> of_cell;        ///< [cell * n_faces(shape) + local face] facet
  std::vector<LocalIndex> fracture_face;  ///< [fracture face] facet
  std::vector<LocalIndex> ridge;  ///< [fracture face * n_face_corners(shape) + k] facet; ridge k is corner k in 2D, the
                                  ///< edge from corner k to the next in 3D
  std::vector<Rim> rims;
  LocalIndex n_owned = 0;
};

/// One rank's part. Owned entities come first in every list, ghosts follow; "n_" counts both, "n_owned_" the first
/// part.
///
/// Ownership: a cell belongs to its part of the partition, a fracture face to the rank of its minus cell, a node to the
/// lowest rank that owns a cell around it. Ghost cells are all cells that share a node with an owned cell, and the
/// opposite cell of every owned fracture face, and the cells on side minus of faces, of any fracture, that end where an
/// owned one does. Local nodes are the nodes of all local cells; local fracture faces are those with at least one local
/// cell. So rows of owned nodes and facets can be assembled from local cells and faces without communication.
struct Mesh {
  struct FractureFace {
    GlobalIndex id;                  ///< global number
    int fracture;                    ///< index into fracture_names
    int single;                      ///< index into single_fractures
    std::array<LocalIndex, 2> cell;  ///< local cell on side minus, plus; -1 where that cell is not on this rank
    std::array<int, 2> local_face;   ///< number of the face in that cell
    std::array<std::array<LocalIndex, max_face_nodes>, 2>
        nodes;  ///< local nodes of each side, the k-th ones coincide; -1 if absent
    std::array<GlobalIndex, 4>
        corners;  ///< numbers of the points at the corners, the same for all faces that end there
    Real area;    ///< length in 2D; metre, metre^2
    std::array<Real, 3> centre;
    std::array<std::array<Real, 3>, 3>
        frame;  ///< rows n, t1[, t2]; 2D t = (n_y, -n_x); 3D t1 = a x n/|a x n|, t2 = n x t1
  };
  struct BoundaryFace {
    int boundary;
    LocalIndex cell;
    int local_face;
    bool owned;  ///< the cell is owned by this rank
  };

  RCP<const Comm> comm;
  Shape shape;
  LocalIndex n_owned_nodes = 0, n_owned_cells = 0, n_owned_fracture_faces = 0;
  LocalIndex n_free_nodes = 0;      ///< nodes with unknowns of their own, owned and ghosts; tied ones follow
  std::vector<LocalIndex> tied_to;  ///< [tied node] the local node that it shares its unknowns with
  std::vector<GlobalIndex> node_id, cell_id;
  std::vector<int> cell_owner;    ///< [cell] rank
  std::vector<Real> coordinates;  ///< [node * dim + component], metre
  std::vector<LocalIndex> cells;  ///< [cell * nodes per cell + local node]
  std::vector<int> cell_region;   ///< [cell]
  std::vector<int> cell_piece;    ///< [cell] which of the pieces of rock between fractures it is in
  std::vector<FractureFace> fracture_faces;
  std::vector<BoundaryFace> boundary_faces;  ///< of all local cells
  std::vector<std::string> region_names, boundary_names, fracture_names;
  std::vector<SingleFracture> single_fractures;  ///< all of the whole mesh, on every rank
  GlobalIndex n_global_nodes = 0, n_global_cells = 0, n_global_fracture_faces = 0;
  int n_pieces = 0;       ///< see find_pieces()
  std::vector<char> tip;  ///< [node] see GlobalMesh; empty: nowhere
  /// Nodes that are no tips but in a cell with one have further unknowns there. They are numbered on their own, owned
  /// ones first.
  std::vector<LocalIndex> enriched;      ///< [node] its number among them; -1 if it is none; empty without tips
  std::vector<GlobalIndex> enriched_id;  ///< [enriched node] global number
  LocalIndex n_owned_enriched = 0;
  GlobalIndex n_global_enriched = 0;
  PartitionReport partition{};  ///< of the whole mesh
  RCP<const Facets> facets;     ///< null where no field lives on them, see with_facets()
  /// Of a part of a mesh: the numbers that local entities have in the whole, see without_regions().
  struct Origin {
    std::vector<GlobalIndex> nodes, cells, fracture_faces, enriched, facets;
  };
  RCP<const Origin> origin;  ///< null: it is whole

  int dim() const { return dimension(shape); }
  int nodes_per_cell() const { return mesh::n_nodes(shape); }
  LocalIndex n_nodes() const { return static_cast<LocalIndex>(node_id.size()); }
  LocalIndex free_node(LocalIndex node) const { return node < n_free_nodes ? node : tied_to[node - n_free_nodes]; }
  LocalIndex n_cells() const { return static_cast<LocalIndex>(cell_id.size()); }
  LocalIndex n_fracture_faces() const { return static_cast<LocalIndex>(fracture_faces.size()); }
};

}  // namespace sprekk::mesh
