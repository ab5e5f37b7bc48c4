#include "io/vtu.hpp"

#include "base/check.hpp"
#include "base/over_ranks.hpp"
#include "base/text.hpp"
#include "io/file.hpp"
#include "mesh/facets.hpp"

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

#include <map>
#include <set>
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

/// Builder of a piece from the corner nodes of its cells. A node becomes a point at its first occurrence.
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

/// Creates a VTK array that shares the memory of `values`. VTK has no const arrays, but the writer only reads. VTK does
/// not escape names.
template <class Array, class T>
vtkNew<Array> borrowed(const std::vector<T>& values, int n_components, const std::string& name) {
  vtkNew<Array> array;
  array->SetName(base::xml_escaped(name).c_str());
  array->SetNumberOfComponents(n_components);
  array->SetArray(const_cast<T*>(values.data()), static_cast<vtkIdType>(values.size()), 1);
  return array;
}

/// Returns the content of a .vtu file: binary, appended, zlib.
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

/// Returns the part of a .pvtu file that declares the arrays, in their order.
std::string declared(const Piece& piece) {
  return fmt::format(
      " GhostLevel=\"0\">\n    <PPointData>\n{}    </PPointData>\n    <PCellData>\n{}    </PCellData>\n    <PPoints>\n"
      "      <PDataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"/>\n    </PPoints>\n",
      declarations(piece.point_data), declarations(piece.cell_data));
}

/// Returns the entry of a file in a list of blocks.
std::string data_set(std::size_t index, const std::string& name, const std::string& file) {
  return fmt::format("      <DataSet index=\"{}\"{} file=\"{}\"/>\n", index, name, base::xml_escaped(file));
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

Piece intersection_piece(const std::vector<mesh::Intersection>& intersections) {
  constexpr int types[] = {VTK_VERTEX, VTK_LINE, VTK_QUADRATIC_EDGE};
  Piece piece;
  piece.nodes_per_cell = intersections.empty() ? 1 : static_cast<int>(intersections.front().nodes.size());
  piece.vtk_cell_type = types[piece.nodes_per_cell - 1];
  std::map<GlobalIndex, LocalIndex> point_of_node;
  piece.cell_data = {{"fractures", 1, {}}, {"faces", 1, {}}, {"first fracture", 1, {}}, {"last fracture", 1, {}}};
  for (const auto& at : intersections) {
    for (std::size_t k = 0; k < at.nodes.size(); ++k) {
      const auto [found, is_new] = point_of_node.emplace(at.nodes[k], piece.n_points());
      if (is_new) piece.points.insert(piece.points.end(), at.x[k].begin(), at.x[k].end());
      piece.connectivity.push_back(found->second);
    }
    const std::set<int> different(at.fractures.begin(), at.fractures.end());
    const std::size_t numbers[] = {different.size(), at.fractures.size(), static_cast<std::size_t>(*different.begin()),
                                   static_cast<std::size_t>(*different.rbegin())};
    for (int i = 0; i < 4; ++i) piece.cell_data[i].values.push_back(static_cast<Real>(numbers[i]));
  }
  return piece;
}

Piece edge_piece(const mesh::Mesh& mesh, const std::vector<mesh::IntersectionEdge>& edges) {
  Piece piece;
  piece.nodes_per_cell = 2;
  piece.vtk_cell_type = VTK_LINE;
  for (const auto& edge : edges)
    for (const int k : {edge.ridge, edge.ridge + 1}) {
      const auto x = mesh::face_corner(mesh, edge.face, k);
      piece.connectivity.push_back(piece.n_points());
      piece.points.insert(piece.points.end(), x.begin(), x.end());
    }
  return piece;
}

Piece part_of(const Piece& piece, const std::vector<LocalIndex>& cells) {
  Piece part;
  part.vtk_cell_type = piece.vtk_cell_type;
  part.nodes_per_cell = piece.nodes_per_cell;
  std::vector<LocalIndex> point_in_part(piece.n_points(), -1);
  for (const auto& array : piece.cell_data) part.cell_data.push_back({array.name, array.n_components, {}});
  for (LocalIndex cell : cells) {
    for (int k = 0; k < piece.nodes_per_cell; ++k) {
      const LocalIndex from = piece.connectivity[cell * piece.nodes_per_cell + k];
      if (point_in_part[from] < 0) {
        point_in_part[from] = part.n_points();
        part.point_node.push_back(piece.point_node[from]);
        part.points.insert(part.points.end(), &piece.points[3 * from], &piece.points[3 * from] + 3);
      }
      part.connectivity.push_back(point_in_part[from]);
    }
    for (std::size_t a = 0; a < piece.cell_data.size(); ++a) {
      const auto& [name, n, values] = piece.cell_data[a];
      part.cell_data[a].values.insert(part.cell_data[a].values.end(), &values[cell * n], &values[cell * n] + n);
    }
  }
  return part;
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

VtuSeries::VtuSeries(RCP<const Comm> comm, std::string directory, std::string name, std::vector<Real> times, Of of)
    : comm_(std::move(comm)),
      directory_(std::move(directory)),
      name_(std::move(name)),
      times_(std::move(times)),
      of_(of) {
  make_directory(*comm_, path(name_));
  base::collectively(*comm_, [&] {
    if (comm_->getRank() == 0 && !times_.empty()) write_list();
  });
}

std::string VtuSeries::step_name(std::size_t step) const { return fmt::format("{}_{:04}", name_, step); }

void VtuSeries::write_list() const {
  std::string steps;
  for (std::size_t i = 0; i < times_.size(); ++i)
    steps += fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", times_[i],
                         base::xml_escaped(step_name(i) + ending()));
  write_file(path(name_ + ".pvd"), vtk_file("Collection", ">\n" + steps));
}

void VtuSeries::add_step(Real time, const std::string& content) {
  times_.push_back(time);
  try {
    base::collectively(*comm_, [&] {
      if (comm_->getRank() != 0) return;
      write_file(path(step_name(times_.size() - 1) + ending()), content);
      write_list();
    });
  } catch (...) {
    times_.pop_back();
    throw;
  }
}

void VtuSeries::write(Real time, const Piece& piece) {
  const auto piece_file = [&](int rank) { return fmt::format("{}/{}_{}.vtu", name_, step_name(times_.size()), rank); };
  const std::string declared_on_0 = base::of_rank(*comm_, 0, declared(piece));
  base::collectively(*comm_, [&] { write_piece(piece_file(comm_->getRank()), piece, declared_on_0); });
  std::string pieces;
  for (int r = 0; r < comm_->getSize(); ++r)
    pieces += fmt::format("    <Piece Source=\"{}\"/>\n", base::xml_escaped(piece_file(r)));
  add_step(time, vtk_file("PUnstructuredGrid", declared_on_0 + pieces));
}

void VtuSeries::write(Real time, const std::vector<Block>& blocks) {
  const auto piece_file = [&](std::size_t block, int rank) {
    return fmt::format("{}/{}_{}_{}.vtu", name_, step_name(times_.size()), block, rank);
  };
  const int n_ranks = comm_->getSize(), rank = comm_->getRank();
  std::vector<int> here(blocks.size() * n_ranks, 0);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const auto& piece = blocks[b].piece;
    const std::string declared_on_0 = base::of_rank(*comm_, 0, declared(piece));
    here[b * n_ranks + rank] = piece.n_cells() > 0;
    base::collectively(*comm_, [&] {
      if (piece.n_cells() > 0) write_piece(piece_file(b, rank), piece, declared_on_0);
    });
  }
  const auto has_cells = base::max_over_ranks(*comm_, here);
  std::string content;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    content += fmt::format("    <Block index=\"{}\" name=\"{}\">\n", b, base::xml_escaped(blocks[b].name));
    for (int r = 0, n = 0; r < n_ranks; ++r)
      if (has_cells[b * n_ranks + r]) content += data_set(n++, "", piece_file(b, r));
    content += "    </Block>\n";
  }
  for (std::size_t k = 0; k < constant_.size(); ++k)
    content += data_set(blocks.size() + k, fmt::format(" name=\"{}\"", base::xml_escaped(constant_[k])),
                        constant_file(constant_[k]));
  add_step(time, vtk_file("vtkMultiBlockDataSet", ">\n" + content));
}

void VtuSeries::keep(const Block& block) {
  base::collectively(*comm_, [&] {
    if (comm_->getRank() == 0) write_piece(constant_file(block.name), block.piece, declared(block.piece));
  });
  if (std::find(constant_.begin(), constant_.end(), block.name) == constant_.end()) constant_.push_back(block.name);
}

void VtuSeries::write_piece(const std::string& file, const Piece& piece, const std::string& declared_on_0) const {
  check_sizes(name_, piece);
  const std::string declared_here = declared(piece);
  SPREKK_CHECK(declared_here == declared_on_0, "output \"{}\": rank {} has other arrays than rank 0:\n{}versus\n{}",
               name_, comm_->getRank(), declared_here, declared_on_0);
  write_file(path(file), vtu_content(piece));
}

}  // namespace sprekk::io
