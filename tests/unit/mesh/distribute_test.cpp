#include "mesh/distribute.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <stdexcept>

#include "mesh/partition.hpp"
#include "meshes.hpp"
#include "parts.hpp"

namespace sprekk::mesh::testing {
namespace {

using ::testing::HasSubstr;

TEST(Distribute, IsAsDocumentedForMetisParts) {
  const auto comm = Tpetra::getDefaultComm();
  for (const auto& cell : all_cells) {
    auto box = crossed(cell);
    box.renumbering_seed = 5;
    box.rotation = 20;
    const auto global = make_box(box);
    expect_as_documented(global, partition(global, comm->getSize()), *make_distributed(global, comm));
  }
}

TEST(Distribute, IsAsDocumentedForScatteredAndSidedParts) {
  const auto comm = Tpetra::getDefaultComm();
  for (const auto& cell : all_cells) {
    const auto global = make_box(crossed(cell));
    std::vector<int> scattered, sided;
    for (GlobalIndex c = 0; c < global.n_cells(); ++c) {
      scattered.push_back(static_cast<int>(c * c % 7) % comm->getSize());
      sided.push_back(cell_centre(global, c)[1] > 2 ? comm->getSize() - 1 : 0);  // cut along fracture "a"; further
                                                                                 // ranks are empty
    }
    expect_as_documented(global, scattered, *distribute(global, scattered, comm));
    expect_as_documented(global, sided, *distribute(global, sided, comm));
  }
}

TEST(Distribute, OnlyRankZeroMakesTheMeshAndAllGetTheSameParts) {
  const auto comm = Tpetra::getDefaultComm();
  for (const auto& cell : all_cells)
    for (int order : {1, 2}) {
      auto box = crossed(cell);
      box.order = order;
      box.rotation = 12;
      const auto global = make_box(box);
      const auto expected = distribute(global, partition(global, comm->getSize()), comm);
      int calls = 0;
      expect_identical(*make_distributed([&] { return ++calls, make_box(box); }, comm), *expected);
      EXPECT_EQ(calls, comm->getRank() == 0 ? 1 : 0);
      expect_identical(*make_distributed(comm->getRank() == 0 ? global : GlobalMesh(), comm), *expected);
    }
}

TEST(Distribute, RanksMayOwnNothing) {
  const auto comm = Tpetra::getDefaultComm();
  const auto single = make_box(unit_steps("hexahedron", {1, 1, 1}));
  const auto mesh = make_distributed(single, comm);
  expect_as_documented(single, {0}, *mesh);
  if (comm->getRank() > 0) {
    EXPECT_EQ(mesh->n_cells(), 0);
    EXPECT_EQ(mesh->n_nodes(), 0);
  }
}

TEST(Distribute, FramesAreOrthonormalAndFollowTheConvention) {
  const auto comm = Tpetra::getDefaultComm();
  for (const auto& cell : all_cells)
    for (Real angle : {0.0, 30.0, 90.0}) {
      auto box = crossed(cell);
      box.rotation = angle;
      box.rotation_axis = {1, 0, 0};
      const auto global = make_box(box);
      const auto mesh = make_distributed(global, comm);
      for (const auto& face : mesh->fracture_faces) {
        const auto& [n, t1, t2] = face.frame;
        const auto& original = global.fracture_faces[face.id];
        const Vector expected = normal(global, original);
        EXPECT_LT(norm(n - expected), 1e-14);
        if (global.dim() == 2) {
          EXPECT_EQ(t1, (Vector{n[1], -n[0], 0}));
          EXPECT_NEAR(norm(n), 1, 1e-15);
          EXPECT_EQ(face.area, norm(area_vector(global, original.cell[minus], original.local_face[minus])));
          EXPECT_NEAR(face.area, 1, 1e-14);
        } else {
          for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) EXPECT_NEAR(dot(face.frame[i], face.frame[j]), i == j, 1e-14);
          const Vector a = std::abs(n[2]) < 0.9 ? Vector{0, 0, 1} : Vector{1, 0, 0};
          EXPECT_NEAR(dot(t1, a), 0, 1e-15);
          EXPECT_GT(dot(t1, cross(a, n)), 0);
          EXPECT_GT(dot(t2, a), 0);
          EXPECT_NEAR(face.area, cell == "tetrahedron" ? 0.5 : 1, 1e-14);
        }
        EXPECT_EQ(face.centre, face_centre(global, original.cell[minus], original.local_face[minus]));
      }
    }
}

TEST(Distribute, Errors) {
  const auto comm = Tpetra::getDefaultComm();
  auto box = unit_steps("quadrilateral", {4, 2});
  box.fractures["f"] = fracture({0, 1}, {4, 1});
  auto mesh = make_box(box);
  std::vector<int> part(8, 0);
  part[3] = comm->getSize();
  EXPECT_THAT(error_of([&] { distribute(mesh, part, comm); }), HasSubstr("cell 3 is in part"));
  part.pop_back();
  EXPECT_THAT(error_of([&] { distribute(mesh, part, comm); }), HasSubstr("7 parts for 8 cells"));
  mesh.coordinates[mesh.coordinates.size() - 1] += 0.1;  // a node that the split has added
  EXPECT_THAT(error_of([&] { make_distributed(mesh, comm); }), HasSubstr("do not coincide"));
  mesh.coordinates.insert(mesh.coordinates.end(), {0, 0});
  EXPECT_THAT(error_of([&] { make_distributed(mesh, comm); }), HasSubstr("belongs to no cell"));

  int calls = 0;
  const auto fail = [&]() -> GlobalMesh {
    ++calls;
    throw std::runtime_error("no such file");
  };
  EXPECT_EQ(error_of([&] { make_distributed(fail, comm); }), "no such file");
  EXPECT_EQ(calls, comm->getRank() == 0 ? 1 : 0);
}

}  // namespace
}  // namespace sprekk::mesh::testing
