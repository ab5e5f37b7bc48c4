// Local refinement: bisection of selected triangles or tetrahedra into a conforming mesh.
#pragma once

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// Straight extension of a fracture from its tip, in 2D.
struct Extension {
  std::array<Real, 2> tip, direction;  ///< position, m; unit vector into the rock; zero: only bisect cells
  Real length;                         ///< m
  Real size;                           ///< largest edge of the cells within `length` of the new faces, m
  Real beyond = 0;  ///< length beyond another fracture that is met and ahead, m; 0: the extension ends there
};

/// Result of an extension: nothing, a new tip, a junction with another fracture, or a tip beyond it.
struct Extended {
  enum How { none, tip, junction, crossing };
  enum Obstacle { flat_cells, boundary, own_fracture, other_fracture };
  How how = none;
  std::array<Real, 2> begin = {}, end = {};  ///< of the last straight part, m
  int met = -1;           ///< single fracture of a junction or crossing, or the obstacle; -1: of a round before
  bool is_ahead = false;  ///< the direction of the extension leads through this fracture
  Obstacle obstacle = flat_cells;  ///< within half of the length, or cells would be too flat, if there is no extension
  bool operator==(How other) const { return how == other; }
};

/// Rotation of the last extension of a fracture about its beginning, counter-clockwise, in 2D.
struct Turn {
  std::array<Real, 2> begin, tip;  ///< of the extension, m
  Real angle;                      ///< rad
};

/// Change of a mesh: bisected cells, then extensions, then turns.
struct MeshChange {
  std::vector<GlobalIndex> cells = {};
  std::vector<Extension> extensions = {};
  std::vector<Turn> turns = {};
  bool is_none() const { return cells.empty() && extensions.empty() && turns.empty(); }
};

/// Intersection of a cell with a cell of the mesh before a change, in 2D.
struct Overlap {
  GlobalIndex cell, before;    ///< numbers in both meshes
  Real area;                   ///< m^2
  std::array<Real, 2> centre;  ///< centroid, m
};

/// Mesh of triangles or tetrahedra, refined by the bisection of Arnold, Mukherjee and Pouly (2000).
///
/// The cutting plane contains the midpoint of the refinement edge and the corners not on this edge. Every face has a
/// marked edge. The marked edge of the face inherited uncut becomes the refinement edge of a child. On cut faces and on
/// the new face between the children, the edge opposite to the new node is marked. There is one exception: if the
/// marked edges of the parent lie in one plane, every second new face has another marked edge. At first the longest
/// edges are marked, so both cells at a face agree. The number of cell shapes is therefore bounded for any number of
/// bisections.
///
/// Both sides of a fracture are cut identically: nodes are merged before and split again after refinement. Faces
/// inherit side, fracture and boundary; cells inherit their region. The result is independent of the number of ranks:
/// each rank that stores the mesh refines it. Not collective.
class Bisection {
 public:
  /// Takes a mesh of order 1 from split(). Throws an Error for cells other than simplices of order 1, or for tied
  /// nodes.
  explicit Bisection(const GlobalMesh& mesh);

  /// Bisects the given cells (numbers in mesh()), and their children `times` - 1 times again. Further cells are
  /// bisected until the mesh conforms; their number per given cell is bounded. Returns the number before of the cell
  /// that contains each new cell.
  std::vector<GlobalIndex> refine(const std::vector<GlobalIndex>& cells, int times = 1);

  /// Bisects cells near the extension to its size. Then moves nodes to the line of the extension or splits edges that
  /// cross it, and adds the edges along the line to the fracture at the tip. Nodes on fractures and boundaries do not
  /// move. If the line ends at another fracture, or less than half of the length before it, the extension ends at a
  /// node of this fracture, or it continues from there by `beyond` if there is room. Without room, only cells
  /// are bisected: if a fracture or a boundary lies within half of the length, or if cells would become too flat.
  /// `parent` as in refine(), of all calls so far. 2D.
  Extended extend(const Extension& extension, std::vector<GlobalIndex>& parent);
  /// Rotates the nodes of an extension, and the nodes around it by a part of the angle. Returns false, without a
  /// change, if cells would become too flat. 2D.
  bool turn(const Turn& turn);
  /// Returns the intersections of the cells with those of the mesh before, where cells were bisected or nodes have
  /// moved. `parent` as in refine(). 3D: none.
  std::vector<Overlap> overlaps(const Bisection& before, const std::vector<GlobalIndex>& parent) const;

  /// Returns the present mesh, split along its fractures. Nodes preserve their numbers; copies of split nodes follow
  /// the new nodes. Children replace their parent in the order of cells. Cells of order 2 have straight edges.
  GlobalMesh mesh(int order = 1) const;

  GlobalIndex n_cells() const { return static_cast<GlobalIndex>(cells_.size()); }

 private:
  using Edge = std::array<signed char, 2>;  ///< two corners of a cell, as local numbers
  struct Cell {
    std::array<GlobalIndex, 4> node;  ///< its corners
    std::array<int, 4> label;  ///< label of the face opposite to each corner, index into labels_; -1: interior face
    int region;
    Edge edge;                   ///< refinement edge
    std::array<Edge, 2> marked;  ///< marked edge of the face opposite to each end of the refinement edge; 3D
    bool flag;                   ///< next new inner face gets the other marked edge, if the marked edges are coplanar
  };
  /// Geometric object of a cell face: a boundary or one side of a fracture.
  struct Label {
    int boundary = -1, fracture = -1, single = 0, side = 0;
  };
  class Middles;
  class Longest;
  class Patch;

  void refine_near(const Extension& extension, Real size, std::vector<GlobalIndex>& parent);
  bool has_room(const Extension& extension, int met);
  bool add_fitting_path(const Extension& extension, int single, bool refines, std::vector<GlobalIndex>& parent);
  bool add_path(const Extension& extension, int single, Real size, std::vector<GlobalIndex>& parent);
  void take_faces(const GlobalMesh& mesh);
  void mark_edges();
  Cell child(const Cell& parent, int keeps, GlobalIndex middle) const;
  void add_faces(GlobalMesh& mesh) const;

  int dim_;
  GlobalMesh empty_;  // names only, no entities
  std::vector<Real> coordinates_;
  std::vector<Cell> cells_;
  std::vector<Label> labels_;
};

}  // namespace sprekk::mesh
