#include "io/vtu.hpp"

#include "base/check.hpp"
#include "base/text.hpp"
#include "io/file.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkTypeInt32Array.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <utility>

namespace sprekk::io {

namespace {

int cell_type(mesh::Shape shape) {
  constexpr int types[] = {VTK_TRIANGLE,
                           VTK_QUAD,
                           VTK_TETRA,
                           VTK_HEXAHEDRON,
                           VTK_QUADRATIC_TRIANGLE,
                           VTK_BIQUADRATIC_QUAD,
                           VTK_QUADRATIC_TETRA,
                           VTK_TRIQUADRATIC_HEXAHEDRON};
  return types[static_cast<int>(shape)];
}

int face_type(mesh::Shape shape) {
  const bool linear = mesh::order(shape) == 1;
  if (mesh::dimension(shape) == 2) return linear ? VTK_LINE : VTK_QUADRATIC_EDGE;
  if (mesh::linear(shape) == mesh::Shape::tetrahedron) return linear ? VTK_TRIANGLE : VTK_QUADRATIC_TRIANGLE;
  return linear ? VTK_QUAD : VTK_BIQUADRATIC_QUAD;
}

/// Adds nodes as corners of cells to a piece; a node becomes a point when it is first met.
class PieceBuilder {
 public:
  PieceBuilder(const mesh::Mesh& mesh, int vtk_cell_type, int nodes_per_cell)
      : mesh_(mesh), point_of_node_(mesh.n_nodes(), -1) {
    piece_.vtk_cell_type = vtk_cell_type;
    piece_.nodes_per_cell = nodes_per_cell;
  }

  void add(LocalIndex node) {
    LocalIndex& point = point_of_node_[node];
    if (point < 0) {
      point = piece_.n_points();
      piece_.point_node.push_back(node);
      for (int c = 0; c < 3; ++c)
        piece_.points.push_back(c < mesh_.dim() ? mesh_.coordinates[node * mesh_.dim() + c] : 0.0);
    }
    piece_.connectivity.push_back(point);
  }

  Piece take() { return std::move(piece_); }

 private:
  const mesh::Mesh& mesh_;
  std::vector<LocalIndex> point_of_node_;
  Piece piece_;
};

/// VTK's view of an array that stays ours. VTK has no const arrays, the writer only reads; it does not escape names.
template <class Array, class T>
vtkNew<Array> borrowed(const std::vector<T>& values, int n_components, const std::string& name) {
  vtkNew<Array> array;
  array->SetName(base::xml_escaped(name).c_str());
  array->SetNumberOfComponents(n_components);
  array->SetArray(const_cast<T*>(values.data()), static_cast<vtkIdType>(values.size()), 1);
  return array;
}

/// The piece as the content of a .vtu file: binary, appended, zlib.
std::string vtu_content(const Piece& piece) {
  vtkNew<vtkPoints> points;
  points->SetData(borrowed<vtkDoubleArray>(piece.points, 3, "Points"));
  std::vector<LocalIndex> offsets(piece.n_cells() + 1);
  for (LocalIndex i = 0; i <= piece.n_cells(); ++i) offsets[i] = i * piece.nodes_per_cell;
  vtkNew<vtkCellArray> cells;
  cells->SetData(borrowed<vtkTypeInt32Array>(offsets, 1, "offsets"),
                 borrowed<vtkTypeInt32Array>(piece.connectivity, 1, "connectivity"));

  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(points);
  grid->SetCells(piece.vtk_cell_type, cells);
  for (const auto& a : piece.point_data)
    grid->GetPointData()->AddArray(borrowed<vtkDoubleArray>(a.values, a.n_components, a.name));
  for (const auto& a : piece.cell_data)
    grid->GetCellData()->AddArray(borrowed<vtkDoubleArray>(a.values, a.n_components, a.name));

  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(grid);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->WriteToOutputStringOn();
  writer->Write();
  return writer->GetOutputString();
}

std::string declarations(const std::vector<DataArray>& arrays) {
  std::string text;
  for (const auto& a : arrays)
    text += fmt::format("      <PDataArray type=\"Float64\" Name=\"{}\" NumberOfComponents=\"{}\"/>\n",
                        base::xml_escaped(a.name), a.n_components);
  return text;
}

std::string vtk_file(const std::string& type, const std::string& body) {
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"{0}\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt32\">\n  <{0}{1}  </{0}>\n</VTKFile>\n",
      type, body);
}

/// The .pvtu without its list of pieces: the arrays, in their order.
std::string declared(const Piece& piece) {
  return fmt::format(
      " GhostLevel=\"0\">\n    <PPointData>\n{}    </PPointData>\n    <PCellData>\n{}    </PCellData>\n    <PPoints>\n"
      "      <PDataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"/>\n    </PPoints>\n",
      declarations(piece.point_data), declarations(piece.cell_data));
}

void check_sizes(const std::string& name, const Piece& piece) {
  const auto check = [&](const std::vector<DataArray>& arrays, LocalIndex n_entities, const char* entities) {
    for (const auto& a : arrays)
      SPREKK_CHECK(a.values.size() == static_cast<std::size_t>(n_entities) * a.n_components,
                   "output \"{}\": array \"{}\" has {} values; {} {} with {} components need {}", name, a.name,
                   a.values.size(), n_entities, entities, a.n_components, n_entities * a.n_components);
  };
  check(piece.point_data, piece.n_points(), "points");
  check(piece.cell_data, piece.n_cells(), "cells");
}

}  // namespace

Piece bulk_piece(const mesh::Mesh& mesh) {
  const int nodes_per_cell = mesh::n_nodes(mesh.shape);
  PieceBuilder builder(mesh, cell_type(mesh.shape), nodes_per_cell);
  for (LocalIndex i = 0; i < mesh.n_owned_cells * nodes_per_cell; ++i) builder.add(mesh.cells[i]);
  return builder.take();
}

Piece fracture_piece(const mesh::Mesh& mesh) {
  const int nodes_per_face = mesh::n_face_nodes(mesh.shape);
  PieceBuilder builder(mesh, face_type(mesh.shape), nodes_per_face);
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f)
    for (int k = 0; k < nodes_per_face; ++k) builder.add(mesh.fracture_faces[f].nodes[mesh::minus][k]);
  return builder.take();
}

DataArray data_array(std::string name, int n_components, std::vector<Real> values) {
  if (n_components != 2) return {std::move(name), n_components, std::move(values)};
  DataArray padded{std::move(name), 3, std::vector<Real>(values.size() / 2 * 3)};
  for (std::size_t i = 0; i < values.size(); ++i) padded.values[i / 2 * 3 + i % 2] = values[i];
  return padded;
}

DataArray nodal_data_array(const Piece& piece, std::string name, int n_components, const std::vector<Real>& nodal) {
  std::vector<Real> values;
  values.reserve(piece.point_node.size() * n_components);
  for (LocalIndex node : piece.point_node)
    for (int c = 0; c < n_components; ++c) values.push_back(nodal[node * n_components + c]);
  return data_array(std::move(name), n_components, std::move(values));
}

VtuSeries::VtuSeries(RCP<const Comm> comm, std::string directory, std::string name, std::vector<Real> times)
    : comm_(std::move(comm)), directory_(std::move(directory)), name_(std::move(name)), times_(std::move(times)) {
  make_directory(*comm_, directory_ + '/' + name_);
  base::collectively(*comm_, [&] {
    if (comm_->getRank() == 0 && !times_.empty()) write_list();
  });
}

void VtuSeries::write_list() const {
  std::string steps;
  for (std::size_t i = 0; i < times_.size(); ++i)
    steps += fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}_{:04}.pvtu\"/>\n", times_[i],
                         base::xml_escaped(name_), i);
  write_file(fmt::format("{}/{}.pvd", directory_, name_), vtk_file("Collection", ">\n" + steps));
}

void VtuSeries::write(Real time, const Piece& piece) {
  const std::string step = fmt::format("{}_{:04}", name_, times_.size());
  const auto piece_file = [&](int rank) { return fmt::format("{}/{}_{}.vtu", name_, step, rank); };
  const std::string declared_here = declared(piece), declared_on_0 = from_rank_0(*comm_, declared_here);
  base::collectively(*comm_, [&] {
    check_sizes(name_, piece);
    SPREKK_CHECK(declared_here == declared_on_0, "output \"{}\": rank {} has other arrays than rank 0:\n{}versus\n{}",
                 name_, comm_->getRank(), declared_here, declared_on_0);
    write_file(directory_ + '/' + piece_file(comm_->getRank()), vtu_content(piece));
  });

  times_.push_back(time);
  try {
    base::collectively(*comm_, [&] {
      if (comm_->getRank() != 0) return;
      std::string pieces;
      for (int r = 0; r < comm_->getSize(); ++r)
        pieces += fmt::format("    <Piece Source=\"{}\"/>\n", base::xml_escaped(piece_file(r)));
      write_file(fmt::format("{}/{}.pvtu", directory_, step), vtk_file("PUnstructuredGrid", declared_here + pieces));
      write_list();
    });
  } catch (...) {
    times_.pop_back();
    throw;
  }
}

}  // namespace sprekk::io
