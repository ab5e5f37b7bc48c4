// The loops that kernels run, and what each entity of a loop touches: tables built once, read by kernels.
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

/// What a kernel runs over. A contact law is evaluated on fracture_faces, each by its owner alone. The linear operators
/// run over cells, fracture_cells and fracture_sides, ghosts included, and write the rows that this rank owns, so
/// assembly sends nothing.
enum class Loop {
  cells,           ///< all local cells
  fracture_sides,  ///< one side of a fracture face, wherever that side's cell is local
  fracture_faces,  ///< owned fracture faces
  fracture_cells,  ///< all local fracture faces, as cells of the fracture
  boundary_faces,  ///< boundary faces of all local cells
  neighbours,      ///< pairs of local cells with a face between them that is no fracture's
  tip_cells,       ///< those of cells that have a crack tip, see mesh::Mesh::tip
  tip_sides        ///< those of fracture_sides whose cell has one
};

/// The entities of Loop::fracture_sides: {fracture face, side}.
std::vector<std::array<LocalIndex, 2>> fracture_sides(const mesh::Mesh& mesh);

/// The entities of Loop::neighbours, of a mesh with facets: the two cells, that with the lower number first.
std::vector<std::array<LocalIndex, 2>> neighbours(const mesh::Mesh& mesh);

/// Local cells that have a crack tip, and the number of an entity of Loop::fracture_sides for each of Loop::tip_sides.
std::vector<LocalIndex> tip_cells(const mesh::Mesh& mesh);
std::vector<LocalIndex> tip_sides(const mesh::Mesh& mesh);
bool has_tip(const mesh::Mesh& mesh, LocalIndex cell);

/// Which entities of a stencil write an owned row, by the first row of a group.
class Writers {
 public:
  Writers(const ConstView<LocalIndex**>& first, LocalIndex n_rows);

  LocalIndex n_rows() const { return static_cast<LocalIndex>(start_.size()) - 2; }
  bool any(LocalIndex first_row) const { return start_[first_row] < start_[first_row + 1]; }

  /// Calls visit(entity, group of the entity) for all that write a group of rows.
  template <class Visit>
  void for_each(LocalIndex first_row, const Visit& visit) const {
    for (LocalIndex k = start_[first_row]; k < start_[first_row + 1]; ++k) visit(entries_[k][0], entries_[k][1]);
  }

 private:
  std::vector<LocalIndex> start_;  // [row + 1]
  std::vector<std::array<LocalIndex, 2>> entries_;
};

/// The unknowns of one field that each entity of a loop touches, as groups of `width` adjacent unknowns:
/// first(entity, group) is the local index (owned first, then ghosts) of the group's first unknown.
///
/// | loop                      | node field                           | fracture-face field                         |
/// | cells, tip_cells          | the cell's nodes                     | -                                           |
/// | fracture_sides, tip_sides | the nodes of the side's cell         | two-sided fields: the side's half; else all |
/// | fracture_faces, fracture_cells | face nodes of side minus, then plus; - | all components                   |
/// | boundary_faces            | the face's nodes                     | -                                           |
///
/// A field on cells has one group in cells, tip_cells, boundary_faces and on sides, that of the cell, and one for each
/// of two neighbours; one on facets all
/// of the cell's, or the face's; on sides and in fracture_faces the fracture face itself, in fracture_cells the face,
/// then its ridges.
///
/// A two-sided field has 2 dim components per face: those of side minus, then those of side plus. A field on enriched
/// nodes is a node field, absent (first = -1) on nodes that are not enriched, and on faces without a tip: there
/// operators read zero, and what they write is dropped.
struct Stencil {
  ConstView<LocalIndex**> first;
  int width = 0;
  std::weak_ptr<std::shared_ptr<const Writers>> writers = {};  ///< where they are kept, if they are
};

Stencil make_stencil(const mesh::Mesh& mesh, Loop loop, const fields::Layout& layout);

/// The stencils of a mesh's fields. Each is made when first asked for; copies share their tables, and their writers.
class Stencils {
 public:
  Stencils(RCP<const mesh::Mesh> mesh, const std::vector<fields::Layout>& layouts) : mesh_(mesh), layouts_(&layouts) {}
  const Stencil& of(Loop loop, int field);
  /// From now on writers are looked for whenever they are needed, and not kept.
  void forget_writers();

 private:
  RCP<const mesh::Mesh> mesh_;
  const std::vector<fields::Layout>* layouts_;
  std::map<std::pair<Loop, int>, Stencil> made_;
  std::vector<std::shared_ptr<std::shared_ptr<const Writers>>> writers_;
  bool keeps_writers_ = true;
};

/// Where a pair of groups stands in the matrix: the entry of (row first_r + i, column first_c + j) is the value number
/// row_begin(first_r + i) + positions(entity, r, c) + j; -1 where the row belongs to another rank or one of them is
/// absent.
ConstView<LocalIndex***> find_positions(const fields::CrsMatrix& matrix, const Stencil& rows, const Stencil& columns);

/// The matrix, all zero, whose pattern holds every pair of groups in the given stencils. All stencils of a row field
/// have one width. Collective.
RCP<fields::CrsMatrix> make_matrix(const fields::Layout& row_layout, const fields::Layout& column_layout,
                                   const std::vector<std::pair<Stencil, Stencil>>& couplings);

}  // namespace sprekk::assembly
