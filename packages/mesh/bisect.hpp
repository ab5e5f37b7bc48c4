// Local refinement: triangles and tetrahedra are halved where it is asked for, and the mesh stays conforming.
#pragma once

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// A mesh of triangles or tetrahedra that cells are halved in, by the rules of Arnold, Mukherjee and Pouly (2000).
///
/// A cell is halved through the middle of its refinement edge and the corners that are not on it. Each face has a
/// marked edge, which is the refinement edge of the child that inherits the face whole; on a face that is cut, and on
/// the new one between the children, it is the edge opposite to the new node, but for new faces of cells whose marked
/// edges lie in one plane, every second time. At first these are the longest edges, so that both cells at a face mark
/// the same one. So cells keep a finite number of shapes, however often they are halved.
///
/// Both sides of a fracture are halved alike, for nodes are joined before and split again after; faces inherit side,
/// fracture and boundary, cells their region. Nothing depends on the number of ranks: who holds the mesh halves it.
class Bisection {
 public:
  /// Of a mesh of order 1 as split() gives it. Throws an Error if it has other cells, or tied nodes.
  explicit Bisection(const GlobalMesh& mesh);

  /// Halves the cells with these numbers in mesh(), and the children `times` - 1 times more; and others until the mesh
  /// conforms, which are a bounded number for each of these.
  void refine(const std::vector<GlobalIndex>& cells, int times = 1);

  /// The mesh as it is, split along its fractures. Nodes keep their numbers, copies of split ones follow the new ones;
  /// children take the place of their parent in the order of cells. Of order 2 with straight edges.
  GlobalMesh mesh(int order = 1) const;

  GlobalIndex n_cells() const { return static_cast<GlobalIndex>(cells_.size()); }

 private:
  using Edge = std::array<signed char, 2>;  ///< two of the corners of a cell, by their places in it
  struct Cell {
    std::array<GlobalIndex, 4> node;  ///< its corners
    std::array<int, 4> label;         ///< of the face opposite to each corner, see Label; -1: nothing is there
    int region;
    Edge edge;                   ///< refinement edge
    std::array<Edge, 2> marked;  ///< of the face opposite to either end of that; in 3D
    bool flag;  ///< whether the next new face inside, of marked edges in one plane, is marked otherwise
  };
  /// What a cell's face lies on: a boundary, or one side of a fracture.
  struct Label {
    int boundary = -1, fracture = -1, single = 0, side = 0;
  };
  class Middles;
  class Longest;

  void take_faces(const GlobalMesh& mesh);
  void mark_edges();
  Cell child(const Cell& parent, int keeps, GlobalIndex middle) const;
  void add_faces(GlobalMesh& mesh) const;

  int dim_;
  GlobalMesh empty_;  // names, and no entities
  std::vector<Real> coordinates_;
  std::vector<Cell> cells_;
  std::vector<Label> labels_;
};

}  // namespace sprekk::mesh
