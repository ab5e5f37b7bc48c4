#include "io/vtu.hpp"

#include "base/check.hpp"
#include "scratch.hpp"

#include <Tpetra_Core.hpp>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLMultiBlockDataReader.h>
#include <vtkXMLPUnstructuredGridReader.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <regex>

namespace sprekk::test {

namespace {

using Grid = vtkSmartPointer<vtkUnstructuredGrid>;
using Vector = std::array<Real, 3>;

const std::vector<mesh::Shape> shapes{mesh::Shape::triangle, mesh::Shape::quadrilateral, mesh::Shape::tetrahedron,
                                      mesh::Shape::hexahedron};

/// Number of unit blocks of rank r in the row [0, n] x [0, 1] (x [0, 1]); rank 1 has none.
int blocks_of(int rank) { return rank == 0 ? 3 : rank == 1 ? 0 : 2; }
int first_block_of(int rank) { return rank < 2 ? 3 * rank : 3 + 2 * (rank - 2); }

/// Returns the cells of one block by corner numbers; corner = x + 2 y + 4 z.
std::vector<std::vector<int>> cells_of_block(mesh::Shape shape) {
  switch (shape) {
    case mesh::Shape::triangle:
      return {{0, 1, 3}, {0, 3, 2}};
    case mesh::Shape::quadrilateral:
      return {{0, 1, 3, 2}};
    case mesh::Shape::hexahedron:
      return {{0, 1, 3, 2, 4, 5, 7, 6}};
    default:
      return {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
  }
}

/// Returns the row of blocks with a ghost block after the owned blocks. Each block has one fracture face on the first
/// face of its first cell, with its ghost. Node 0 belongs to the ghost block; thus points and nodes have different
/// numbers.
mesh::Mesh row_of_blocks(const RCP<const Comm>& comm, mesh::Shape shape) {
  mesh::Mesh mesh;
  mesh.comm = comm;
  mesh.shape = shape;
  const int n_corners = 1 << mesh.dim(), per_layer = n_corners / 2, rank = comm->getRank();
  const int n_blocks = blocks_of(rank) + 1, first = first_block_of(rank);
  for (int layer = n_blocks; layer >= 0; --layer)
    for (int c = 0; c < per_layer; ++c) {
      mesh.node_id.push_back((first + layer) * per_layer + c);
      mesh.coordinates.push_back(first + layer);
      for (int d = 0; d + 1 < mesh.dim(); ++d) mesh.coordinates.push_back(c >> d & 1);
    }
  for (int b = 0; b < n_blocks; ++b) {
    const int n_cells_before = mesh.n_cells();
    for (const auto& cell : cells_of_block(shape)) {
      for (int corner : cell) mesh.cells.push_back((n_blocks - b - (corner & 1)) * per_layer + corner / 2);
      mesh.cell_id.push_back(static_cast<GlobalIndex>(first + b) * cells_of_block(shape).size() + mesh.n_cells() -
                             n_cells_before);
      mesh.cell_region.push_back(0);
    }
    mesh::Mesh::FractureFace face{};
    face.id = first + b;
    for (int k = 0; k < mesh::n_face_nodes(shape); ++k)
      face.nodes[mesh::minus][k] = mesh.cells[n_cells_before * mesh::n_nodes(shape) + mesh::face_nodes(shape)[0][k]];
    mesh.fracture_faces.push_back(face);
  }
  mesh.n_owned_cells = (n_blocks - 1) * static_cast<int>(cells_of_block(shape).size());
  mesh.n_owned_fracture_faces = n_blocks - 1;
  return mesh;
}

Vector displacement(const Real* x) { return {1 + x[0] - x[1], 2 * x[0] + 3 * x[1] - x[2], x[2] - x[0]}; }

io::Piece bulk_with_data(const mesh::Mesh& mesh) {
  io::Piece piece = io::bulk_piece(mesh);
  std::vector<Real> nodal, id;
  for (LocalIndex n = 0; n < mesh.n_nodes(); ++n) {
    Vector x{};
    std::copy_n(&mesh.coordinates[n * mesh.dim()], mesh.dim(), x.begin());
    const Vector u = displacement(x.data());
    nodal.insert(nodal.end(), u.begin(), u.begin() + mesh.dim());
  }
  for (LocalIndex c = 0; c < mesh.n_owned_cells; ++c) id.push_back(static_cast<Real>(mesh.cell_id[c]));
  piece.point_data = {io::nodal_data_array(piece, "displacement", mesh.dim(), nodal)};
  piece.cell_data = {io::data_array("id", 1, id), io::data_array("a < b & \"c\"", 6, std::vector<Real>(6 * id.size()))};
  return piece;
}

Grid read(const std::string& path) {
  vtkNew<vtkXMLPUnstructuredGridReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  return reader->GetOutput();
}

/// Returns length, area or volume: the sum over the simplices of VTK's triangulation of the cell.
Real measure(vtkCell* cell) {
  vtkNew<vtkIdList> ids;
  vtkNew<vtkPoints> points;
  cell->Triangulate(0, ids, points);
  const int dim = cell->GetCellDimension();
  Real sum = 0;
  for (vtkIdType s = 0; s < points->GetNumberOfPoints(); s += dim + 1) {
    Real e[3][3] = {};
    for (int i = 0; i < dim; ++i)
      for (int c = 0; c < 3; ++c) e[i][c] = points->GetPoint(s + i + 1)[c] - points->GetPoint(s)[c];
    const Vector n{e[0][1] * e[1][2] - e[0][2] * e[1][1], e[0][2] * e[1][0] - e[0][0] * e[1][2],
                   e[0][0] * e[1][1] - e[0][1] * e[1][0]};
    sum += dim == 1   ? std::hypot(e[0][0], e[0][1], e[0][2])
           : dim == 2 ? std::hypot(n[0], n[1], n[2]) / 2
                      : std::abs(n[0] * e[2][0] + n[1] * e[2][1] + n[2] * e[2][2]) / 6;
  }
  return sum;
}

struct Contents {
  std::map<std::string, double> steps;  ///< file -> time
  explicit Contents(const std::string& pvd) {
    const std::string text = content(pvd);
    const std::regex entry("<DataSet timestep=\"([^\"]*)\" part=\"0\" file=\"([^\"]*)\"/>");
    for (std::sregex_iterator m(text.begin(), text.end(), entry), end; m != end; ++m)
      steps[(*m)[2]] = std::stod((*m)[1]);
    EXPECT_TRUE(contains(text, "</VTKFile>"));
  }
};

}  // namespace

TEST(Vtu, BulkReadsBackWithPointsCellsAndArrays) {
  const auto comm = Tpetra::getDefaultComm();
  for (const auto shape : shapes) {
    const Scratch scratch(*comm);
    const auto mesh = row_of_blocks(comm, shape);
    io::VtuSeries series(comm, scratch / "out", "bulk");
    series.write(0, bulk_with_data(mesh));

    const Grid grid = read(scratch / "out/bulk_0000.pvtu");
    const int n_blocks = first_block_of(comm->getSize());
    const int per_block = static_cast<int>(cells_of_block(shape).size());
    ASSERT_EQ(grid->GetNumberOfCells(), n_blocks * per_block);
    vtkDataArray* u = grid->GetPointData()->GetArray("displacement");
    ASSERT_TRUE(u && u->GetNumberOfComponents() == 3);
    for (vtkIdType p = 0; p < grid->GetNumberOfPoints(); ++p) {
      const Vector exact = displacement(grid->GetPoint(p));
      for (int c = 0; c < 2; ++c) EXPECT_EQ(u->GetComponent(p, c), exact[c]);
      EXPECT_EQ(u->GetComponent(p, 2), mesh.dim() == 3 ? exact[2] : 0);
    }
    vtkDataArray* id = grid->GetCellData()->GetArray("id");
    ASSERT_TRUE(id && grid->GetCellData()->GetArray("a < b & \"c\""));
    EXPECT_EQ(grid->GetCellData()->GetArray("a < b & \"c\"")->GetNumberOfComponents(), 6);
    Real volume = 0, integral = 0;
    for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c) {
      const Real measured = measure(grid->GetCell(c));
      volume += measured;
      integral += measured * id->GetComponent(c, 0);
      EXPECT_EQ(std::floor((grid->GetCell(c)->GetBounds()[0] + grid->GetCell(c)->GetBounds()[1]) / 2),
                std::floor(id->GetComponent(c, 0) / per_block));
    }
    const int n_cells = n_blocks * per_block;
    EXPECT_NEAR(volume, n_blocks, 1e-13 * n_blocks);
    EXPECT_NEAR(integral, n_cells * (n_cells - 1) / 2.0 / per_block, 1e-12 * n_cells);
  }
}

TEST(Vtu, FractureFacesReadBack) {
  const auto comm = Tpetra::getDefaultComm();
  for (const auto shape : shapes) {
    const Scratch scratch(*comm);
    const auto mesh = row_of_blocks(comm, shape);
    io::Piece piece = io::fracture_piece(mesh);
    std::vector<Real> slip;
    for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
      slip.push_back(static_cast<Real>(mesh.fracture_faces[f].id));
      slip.push_back(-1);
    }
    piece.cell_data = {io::data_array("slip", 2, slip)};
    io::VtuSeries series(comm, scratch / "out", "fractures");
    series.write(0, piece);

    const Grid grid = read(scratch / "out/fractures_0000.pvtu");
    const int n_blocks = first_block_of(comm->getSize());
    ASSERT_EQ(grid->GetNumberOfCells(), n_blocks);
    const bool tetrahedra = shape == mesh::Shape::tetrahedron;  // their face is half a side, at the end of the block
    vtkDataArray* read_slip = grid->GetCellData()->GetArray("slip");
    for (vtkIdType f = 0; f < n_blocks; ++f) {
      EXPECT_EQ(grid->GetCell(f)->GetCellDimension(), mesh.dim() - 1);
      EXPECT_NEAR(measure(grid->GetCell(f)), tetrahedra ? 0.5 : 1, 1e-14);
      EXPECT_EQ(grid->GetCell(f)->GetBounds()[0], read_slip->GetComponent(f, 0) + tetrahedra);
      EXPECT_EQ(read_slip->GetComponent(f, 1), -1);
      EXPECT_EQ(read_slip->GetComponent(f, 2), 0);
    }
  }
}

TEST(Vtu, CollectionListsEveryStepAfterEveryWrite) {
  const auto comm = Tpetra::getDefaultComm();
  const Scratch scratch(*comm);
  io::Piece piece = bulk_with_data(row_of_blocks(comm, mesh::Shape::quadrilateral));
  io::VtuSeries series(comm, scratch / "out", "bulk");
  const std::vector<Real> times{0, 0.1, 1.0 / 3, 3.15576e9};
  for (std::size_t i = 0; i < times.size(); ++i) {
    series.write(times[i], piece);
    const Contents contents(scratch / "out/bulk.pvd");
    ASSERT_EQ(contents.steps.size(), i + 1);
    for (std::size_t k = 0; k <= i; ++k) {
      const std::string file = "bulk_000" + std::to_string(k) + ".pvtu";
      EXPECT_EQ(contents.steps.at(file), times[k]);
      EXPECT_EQ(read(scratch / ("out/" + file))->GetNumberOfCells(), first_block_of(comm->getSize()));
    }
  }
}

TEST(Vtu, BlocksReadBackByTheirNames) {
  const auto comm = Tpetra::getDefaultComm();
  for (const auto shape : shapes) {
    const Scratch scratch(*comm);
    const auto mesh = row_of_blocks(comm, shape);
    io::Piece all = io::fracture_piece(mesh);
    std::vector<LocalIndex> even, odd, none;
    std::vector<Real> id;
    for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
      id.insert(id.end(), {static_cast<Real>(mesh.fracture_faces[f].id), -1});
      (mesh.fracture_faces[f].id % 2 ? odd : even).push_back(f);
    }
    all.cell_data = {io::data_array("id", 2, id)};
    io::VtuSeries series(comm, scratch / "out", "fractures", {}, io::VtuSeries::Of::blocks);
    std::vector<mesh::Intersection> meeting;
    if (comm->getRank() == 0)
      meeting = {{{4, 7}, {{0, 0, 0}, {1, 0, 0}}, {0, 0, 2}}, {{7, 9}, {{1, 0, 0}, {3, 0, 0}}, {1, 2}}};
    series.keep({"meeting", io::intersection_piece(meeting)});
    const std::string odd_name = "odd < & \"";
    for (Real time : {0.5, 1.5})
      series.write(
          time,
          {{"even", io::part_of(all, even)}, {odd_name, io::part_of(all, odd)}, {"none", io::part_of(all, none)}});
    EXPECT_EQ(Contents(scratch / "out/fractures.pvd").steps,
              (std::map<std::string, double>{{"fractures_0000.vtm", 0.5}, {"fractures_0001.vtm", 1.5}}));

    vtkNew<vtkXMLMultiBlockDataReader> reader;
    reader->SetFileName((scratch / "out/fractures_0001.vtm").c_str());
    reader->Update();
    auto* blocks = vtkMultiBlockDataSet::SafeDownCast(reader->GetOutput());
    ASSERT_EQ(blocks->GetNumberOfBlocks(), 4u);
    const auto name = [&](int k) { return std::string(blocks->GetMetaData(k)->Get(vtkCompositeDataSet::NAME())); };
    EXPECT_EQ(name(0) + name(1) + name(2) + name(3), "even" + odd_name + "nonemeeting");
    int n_faces = 0;
    for (int k : {0, 1, 2}) {
      auto* pieces = vtkMultiBlockDataSet::SafeDownCast(blocks->GetBlock(k));
      for (unsigned i = 0; i < pieces->GetNumberOfBlocks(); ++i) {
        auto* grid = vtkUnstructuredGrid::SafeDownCast(pieces->GetBlock(i));
        ASSERT_GT(grid->GetNumberOfCells(), 0);
        EXPECT_LE(grid->GetNumberOfPoints(), grid->GetNumberOfCells() * mesh::n_face_nodes(shape));
        const bool tetrahedra = shape == mesh::Shape::tetrahedron;  // see FractureFacesReadBack
        for (vtkIdType f = 0; f < grid->GetNumberOfCells(); ++f, ++n_faces) {
          const Real* tuple = grid->GetCellData()->GetArray("id")->GetTuple3(f);
          EXPECT_EQ(static_cast<int>(tuple[0]) % 2, k);
          EXPECT_EQ(tuple[1], -1);
          EXPECT_EQ(grid->GetCell(f)->GetBounds()[0], tuple[0] + tetrahedra);
        }
      }
    }
    EXPECT_EQ(n_faces, first_block_of(comm->getSize()));
    auto* saved = vtkUnstructuredGrid::SafeDownCast(blocks->GetBlock(3));
    ASSERT_TRUE(saved && saved->GetNumberOfCells() == 2);
    EXPECT_EQ(saved->GetNumberOfPoints(), 3);
    const auto value = [&](const char* array, int c) {
      return saved->GetCellData()->GetArray(array)->GetComponent(c, 0);
    };
    EXPECT_EQ(value("fractures", 0), 2);
    EXPECT_EQ(value("faces", 0), 3);
    EXPECT_EQ(value("first fracture", 1), 1);
    EXPECT_EQ(value("last fracture", 1), 2);
    EXPECT_EQ(measure(saved->GetCell(1)), 2);
  }
}

TEST(Vtu, GridWithoutAnyCell) {
  const auto comm = Tpetra::getDefaultComm();
  const Scratch scratch(*comm);
  auto mesh = row_of_blocks(comm, mesh::Shape::quadrilateral);
  mesh.n_owned_fracture_faces = 0;
  io::Piece piece = io::fracture_piece(mesh);
  piece.cell_data = {io::data_array("slip", 2, {})};
  io::VtuSeries(comm, scratch / "out", "fractures").write(0, piece);
  const Grid grid = read(scratch / "out/fractures_0000.pvtu");
  EXPECT_EQ(grid->GetNumberOfCells(), 0);
  EXPECT_EQ(grid->GetCellData()->GetNumberOfArrays(), 1);
}

TEST(Vtu, FailedStepIsAnErrorOnEveryRankAndNotListed) {
  const auto comm = Tpetra::getDefaultComm();
  const Scratch scratch(*comm);
  const io::Piece piece = bulk_with_data(row_of_blocks(comm, mesh::Shape::quadrilateral));
  io::VtuSeries series(comm, scratch / "out", "bulk");
  series.write(0, piece);
  const std::string last_piece = scratch / ("out/bulk/bulk_0001_" + std::to_string(comm->getSize() - 1) + ".vtu");
  for (const auto& path : {last_piece, scratch / "out/bulk_0001.pvtu", scratch / "out/bulk.pvd"}) {
    scratch.on_rank_0([&] { std::filesystem::create_symlink("/dev/full", path + ".part"); });
    const auto message = error_of<Error>([&] { series.write(1, piece); });
    EXPECT_TRUE(contains(message, path)) << message;
    EXPECT_TRUE(contains(message, "No space left")) << message;
    EXPECT_EQ(Contents(scratch / "out/bulk.pvd").steps.size(), 1u);
  }
  series.write(1, piece);
  EXPECT_EQ(Contents(scratch / "out/bulk.pvd").steps.size(), 2u);
}

TEST(Vtu, DirectoryThatCannotBeMade) {
  const auto comm = Tpetra::getDefaultComm();
  EXPECT_TRUE(contains(error_of<Error>([&] { io::VtuSeries(comm, "/proc/sprekk", "bulk"); }), "/proc/sprekk"));
}

TEST(Vtu, ArraysOfWrongSizeOrDifferentOnRanks) {
  const auto comm = Tpetra::getDefaultComm();
  const Scratch scratch(*comm);
  const io::Piece good = bulk_with_data(row_of_blocks(comm, mesh::Shape::quadrilateral));
  io::VtuSeries series(comm, scratch / "out", "bulk");
  io::Piece piece = good;
  if (comm->getRank() == 0) piece.cell_data[0].values.push_back(0);
  const auto size = error_of<Error>([&] { series.write(0, piece); });
  EXPECT_TRUE(contains(size, "array \"id\" has 4 values; 3 cells with 1 components need 3")) << size;
  if (comm->getSize() == 1) return;
  piece = good;
  if (comm->getRank() == 1) piece.cell_data[0].name = "other";
  const auto other = error_of<Error>([&] { series.write(0, piece); });
  EXPECT_TRUE(contains(other, "rank 1 has other arrays than rank 0")) << other;
}

}  // namespace sprekk::test
