// Time series for ParaView: unstructured grids of the bulk and of the fractures, one piece per rank.
#pragma once

#include "base/types.hpp"
#include "mesh/intersections.hpp"
#include "mesh/mesh.hpp"

#include <string>
#include <vector>

namespace sprekk::io {

/// Values on the points or cells of a piece: [entity * n_components + component]. ParaView wants vectors with three
/// components, also in 2D, and symmetric tensors with six in the order XX, YY, ZZ, XY, YZ, XZ.
struct DataArray {
  std::string name;
  int n_components;
  std::vector<Real> values;
};

/// One rank's part of a grid of cells of one kind. Every rank has the same arrays, by name, components and order, also
/// where it has no cells.
struct Piece {
  std::vector<Real> points;              ///< [point * 3 + component], metre; z = 0 in 2D
  std::vector<LocalIndex> point_node;    ///< [point] the local node of the mesh that the point shows
  std::vector<LocalIndex> connectivity;  ///< [cell * nodes_per_cell + k], points
  int vtk_cell_type;                     ///< as in vtkCellType.h
  int nodes_per_cell;
  std::vector<DataArray> point_data, cell_data;

  LocalIndex n_points() const { return static_cast<LocalIndex>(points.size() / 3); }
  LocalIndex n_cells() const { return static_cast<LocalIndex>(connectivity.size()) / nodes_per_cell; }
};

/// The owned cells in their local order, without data. A point for each node of these cells.
Piece bulk_piece(const mesh::Mesh& mesh);

/// The owned fracture faces in their local order, without data: lines, triangles or quadrilaterals at the nodes of side
/// minus. A point for each of these nodes.
Piece fracture_piece(const mesh::Mesh& mesh);

/// Points or lines where fractures meet, without ranks: all of them are on rank 0. Cells have how many "fractures" meet
/// there, how many "faces" end there, and the lowest and highest number of the fractures, "first" and "last fracture".
Piece intersection_piece(const std::vector<mesh::Intersection>& intersections);

/// Some of the cells of a piece that has no point data, with their points and data.
Piece part_of(const Piece& piece, const std::vector<LocalIndex>& cells);

/// An array of cell or point values: [entity * n_components + component]. Two components are taken for a plane vector
/// and get a third one, 0.
DataArray data_array(std::string name, int n_components, std::vector<Real> values);

/// The same from values at all local nodes of the mesh, at the points of the piece.
DataArray nodal_data_array(const Piece& piece, std::string name, int n_components, const std::vector<Real>& nodal);

/// A grid that has a name among others.
struct Block {
  std::string name;
  Piece piece;
};

/// Steps in time. The step number 3 is DIRECTORY/NAME_0003.pvtu with the pieces of the ranks in DIRECTORY/NAME/;
/// DIRECTORY/NAME.pvd lists all steps and is complete after every write. Steps of blocks are NAME_0003.vtm, with the
/// pieces of ranks that have cells of a block.
class VtuSeries {
 public:
  /// What the steps of a series are.
  enum class Of { grids, blocks };

  /// Makes the directories. The series goes on after the steps at `times`, which are there already. Collective; Error
  /// on every rank, naming the path.
  VtuSeries(RCP<const Comm> comm, std::string directory, std::string name, std::vector<Real> times = {},
            Of of = Of::grids);

  /// Adds the step at `time`, second. Collective. Error on every rank when an array has the wrong size or is not the
  /// same on all ranks, or when a file cannot be written; the series then stands as before the call.
  void write(Real time, const Piece& piece);
  /// The same of blocks, which have the same names and order on all ranks.
  void write(Real time, const std::vector<Block>& blocks);

  /// Adds rank 0's block to all steps that follow: DIRECTORY/NAME/BLOCK.vtu, written once. Collective, as write().
  void keep(const Block& block);

  const std::vector<Real>& times() const { return times_; }

 private:
  std::string step_name(std::size_t step) const;
  std::string path(const std::string& file) const { return directory_ + '/' + file; }
  std::string kept_file(const std::string& block) const { return name_ + '/' + block + ".vtu"; }
  const char* ending() const { return of_ == Of::grids ? ".pvtu" : ".vtm"; }
  /// Checks its arrays, also against those of rank 0. Not collective.
  void write_piece(const std::string& file, const Piece& piece, const std::string& declared_on_0) const;
  void add_step(Real time, const std::string& content);  ///< content of the step's own file; collective
  void write_list() const;                               ///< NAME.pvd; not collective

  RCP<const Comm> comm_;
  std::string directory_, name_;
  std::vector<Real> times_;
  Of of_;
  std::vector<std::string> kept_;  ///< names of blocks
};

}  // namespace sprekk::io
