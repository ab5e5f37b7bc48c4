// Time series for ParaView: unstructured grids of the rock and the fractures, one piece for each rank.
#pragma once

#include "base/types.hpp"
#include "mesh/intersections.hpp"
#include "mesh/mesh.hpp"

#include <string>
#include <vector>

namespace sprekk::io {

/// Values on the points or cells of a piece: [entity * n_components + component]. ParaView requires vectors with three
/// components, also in 2D, and symmetric tensors with six, in the order XX, YY, ZZ, XY, YZ, XZ.
struct DataArray {
  std::string name;
  int n_components;
  std::vector<Real> values;
};

/// Part of a grid on one rank, with cells of one kind. The arrays have the same names, components and order on every
/// rank, also on ranks without cells.
struct Piece {
  std::vector<Real> points;              ///< [point * 3 + component], m; z = 0 in 2D
  std::vector<LocalIndex> point_node;    ///< [point] local node of the mesh
  std::vector<LocalIndex> connectivity;  ///< [cell * nodes_per_cell + k] point
  int vtk_cell_type;                     ///< as in vtkCellType.h
  int nodes_per_cell;
  std::vector<DataArray> point_data, cell_data;

  LocalIndex n_points() const { return static_cast<LocalIndex>(points.size() / 3); }
  LocalIndex n_cells() const { return static_cast<LocalIndex>(connectivity.size()) / nodes_per_cell; }
};

/// Returns the owned cells in their local order, without data. There is one point for each node of these cells.
Piece bulk_piece(const mesh::Mesh& mesh);

/// Returns the owned fracture faces in their local order, without data: lines, triangles or quadrilaterals at the nodes
/// of side -. There is one point for each of these nodes.
Piece fracture_piece(const mesh::Mesh& mesh);

/// Returns the points or lines where fractures meet. All of them are on rank 0. Cell data: number of "fractures",
/// number of "faces" that end there, and the lowest and highest fracture number ("first fracture", "last fracture").
Piece intersection_piece(const std::vector<mesh::Intersection>& intersections);

/// Returns the edges as lines, without data.
Piece edge_piece(const mesh::Mesh& mesh, const std::vector<mesh::IntersectionEdge>& edges);

/// Returns some cells of a piece, with their points and cell data. The piece must have no point data.
Piece part_of(const Piece& piece, const std::vector<LocalIndex>& cells);

/// Creates an array of cell or point values: [entity * n_components + component]. Two components are a vector in 2D,
/// extended by a third component 0.
DataArray data_array(std::string name, int n_components, std::vector<Real> values);

/// Creates an array on the points of the piece from the values `nodal` at all local nodes of the mesh.
DataArray nodal_data_array(const Piece& piece, std::string name, int n_components, const std::vector<Real>& nodal);

/// Named grid of a multi-block step.
struct Block {
  std::string name;
  Piece piece;
};

/// Time series of grids. Step 3 is DIRECTORY/NAME_0003.pvtu, with the pieces of the ranks in DIRECTORY/NAME/.
/// DIRECTORY/NAME.pvd lists all steps and is complete after every write. Steps of blocks are NAME_0003.vtm, with the
/// pieces of the ranks that have cells of a block.
class VtuSeries {
 public:
  /// Type of the steps: single grids or lists of blocks.
  enum class Of { grids, blocks };

  /// Creates the directories. The series continues after the existing steps at `times`, s. Throws an Error with the
  /// path on every rank. Collective.
  VtuSeries(RCP<const Comm> comm, std::string directory, std::string name, std::vector<Real> times = {},
            Of of = Of::grids);

  /// Adds the step at `time`, s. Throws an Error on every rank if an array has a wrong size, if arrays differ between
  /// ranks, or if a file cannot be written; the series is then unchanged. Collective.
  void write(Real time, const Piece& piece);
  /// Adds a step of blocks, which must have the same names and order on all ranks. Collective.
  void write(Real time, const std::vector<Block>& blocks);

  /// Adds a block of rank 0 to all later steps, as DIRECTORY/NAME/BLOCK.vtu, or replaces it. Throws as write().
  /// Collective.
  void keep(const Block& block);

  const std::vector<Real>& times() const { return times_; }

 private:
  std::string step_name(std::size_t step) const;
  std::string path(const std::string& file) const { return directory_ + '/' + file; }
  std::string constant_file(const std::string& block) const { return name_ + '/' + block + ".vtu"; }
  const char* ending() const { return of_ == Of::grids ? ".pvtu" : ".vtm"; }
  /// Checks the arrays, also against those of rank 0, and writes the file. Not collective.
  void write_piece(const std::string& file, const Piece& piece, const std::string& declared_on_0) const;
  void add_step(Real time, const std::string& content);  ///< `content` of the file of the step; collective
  void write_list() const;                               ///< writes NAME.pvd; not collective

  RCP<const Comm> comm_;
  std::string directory_, name_;
  std::vector<Real> times_;
  Of of_;
  std::vector<std::string> constant_;  ///< names of blocks
};

}  // namespace sprekk::io
