// Loops of kernels, and tables of the unknowns of each entity. Tables are built once and read by kernels.
#pragma once

#include "base/types.hpp"
#include "fields/layout.hpp"
#include "mesh/mesh.hpp"

#include <array>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace sprekk::assembly {

/// Entities of a kernel loop. The owner of a fracture face evaluates its contact law (loop fracture_faces). Linear
/// operators run over cells, fracture_cells and fracture_sides, including ghosts, and write owned rows only. Assembly
/// therefore needs no communication.
enum class Loop {
  cells,           ///< all local cells
  fracture_sides,  ///< sides of fracture faces with a local cell
  fracture_faces,  ///< owned fracture faces
  fracture_cells,  ///< all local fracture faces, as cells of the fracture
  boundary_faces,  ///< boundary faces of all local cells
  neighbours,      ///< pairs of local cells with a common face that is not on a fracture
  junctions,       ///< pairs of edges at points of intersections in 3D; see mesh::for_each_pair()
  tip_cells,       ///< cells with a crack tip; see mesh::Mesh::tip
  tip_sides,       ///< fracture_sides whose cell has a crack tip
  facets           ///< owned facets
};

/// Returns the entities of Loop::fracture_sides: {fracture face, side}. Not collective.
std::vector<std::array<LocalIndex, 2>> fracture_sides(const mesh::Mesh& mesh);

/// Returns the entities of Loop::neighbours: two cells each, the smaller global number first. Requires facets. Not
/// collective.
std::vector<std::array<LocalIndex, 2>> neighbours(const mesh::Mesh& mesh);

/// Return the local cells with a crack tip, and the index in fracture_sides() of each entity of Loop::tip_sides.
std::vector<LocalIndex> tip_cells(const mesh::Mesh& mesh);
std::vector<LocalIndex> tip_sides(const mesh::Mesh& mesh);
bool has_tip(const mesh::Mesh& mesh, LocalIndex cell);

/// Table of the entities of a stencil that write each owned row, by the first row of a group.
class Writers {
 public:
  Writers(const ConstView<LocalIndex**>& first, LocalIndex n_rows);

  LocalIndex n_rows() const { return static_cast<LocalIndex>(start_.size()) - 2; }
  bool any(LocalIndex first_row) const { return start_[first_row] < start_[first_row + 1]; }

  /// Calls visit(entity, group of the entity) for each entity that writes this group of rows.
  template <class Visit>
  void for_each(LocalIndex first_row, const Visit& visit) const {
    for (LocalIndex k = start_[first_row]; k < start_[first_row + 1]; ++k) visit(entries_[k][0], entries_[k][1]);
  }

 private:
  std::vector<LocalIndex> start_;  // [row + 1]
  std::vector<std::array<LocalIndex, 2>> entries_;
};

/// Unknowns of one field touched by each entity of a loop, in groups of `width` adjacent unknowns. first(entity, group)
/// is the local index of a group's first unknown, owned unknowns first, then ghosts.
///
/// | loop                      | node field                           | fracture-face field                         |
/// | cells, tip_cells          | the cell's nodes                     | -                                           |
/// | fracture_sides, tip_sides | the nodes of the side's cell         | two-sided fields: the side's half; else all |
/// | fracture_faces            | face nodes of side minus, then plus  | all components                              |
/// | fracture_cells            | -                                    | all components                              |
/// | boundary_faces            | the face's nodes                     | -                                           |
///
/// | loop                      | cell field     | facet field                                                       |
/// | cells                     | the cell       | the cell's facets                                                 |
/// | tip_cells                 | the cell       | -                                                                 |
/// | boundary_faces            | the cell       | the face                                                          |
/// | fracture_sides, tip_sides | side's cell    | the fracture face                                                 |
/// | fracture_faces            | -              | the fracture face                                                 |
/// | fracture_cells            | -              | the fracture face, then its ridges                                |
/// | neighbours                | both cells     | -                                                                 |
/// | junctions                 | -              | both ridges                                                       |
/// | facets                    | -              | the facet                                                         |
///
/// A two-sided field has 2 dim components per face: side minus, then side plus. A field on enriched nodes is absent
/// (first = -1) on nodes without enrichment, and in fracture_faces on faces without a tip. Operators read zero for
/// absent unknowns, and values written to absent rows are discarded.
struct Stencil {
  ConstView<LocalIndex**> first;
  int width = 0;
  std::weak_ptr<std::shared_ptr<const Writers>> writers = {};  ///< shared cache of the writers, if there is one
};

/// Returns the stencil of a field in a loop. Throws an Error if the field has none there. Local.
Stencil make_stencil(const mesh::Mesh& mesh, Loop loop, const fields::Layout& layout);

/// Stencils of the fields of a mesh, created on first use. Copies share their tables and writers.
class Stencils {
 public:
  Stencils(RCP<const mesh::Mesh> mesh, const std::vector<fields::Layout>& layouts) : mesh_(mesh), layouts_(&layouts) {}
  /// Returns the stencil of a field in a loop, see make_stencil(). Local.
  const Stencil& of(Loop loop, int field);
  /// Discards all writers. From now on they are computed on each use and not stored.
  void forget_writers();

 private:
  RCP<const mesh::Mesh> mesh_;
  const std::vector<fields::Layout>* layouts_;
  std::map<std::pair<Loop, int>, Stencil> made_;
  std::vector<std::shared_ptr<std::shared_ptr<const Writers>>> writers_;
  bool keeps_writers_ = true;
};

/// Returns the positions of pairs of groups in a matrix. The entry (first_r + i, first_c + j) has the value number
/// row_begin(first_r + i) + positions(entity, r, c) + j. A position is -1 if the row is not owned or a group is absent.
/// Throws an Error if the matrix lacks an entry. Local.
ConstView<LocalIndex***> find_positions(const fields::CrsMatrix& matrix, const Stencil& rows, const Stencil& columns);

/// Returns a zero matrix whose pattern contains each pair of groups in the stencils. All stencils of a row field must
/// have the same width, else it throws an Error. Collective.
RCP<fields::CrsMatrix> make_matrix(const fields::Layout& row_layout, const fields::Layout& column_layout,
                                   const std::vector<std::pair<Stencil, Stencil>>& couplings);

}  // namespace sprekk::assembly
