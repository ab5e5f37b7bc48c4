// Checks of the parts of a distributed mesh.
#pragma once

#include <Teuchos_CommHelpers.hpp>
#include <algorithm>
#include <set>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/facets.hpp"
#include "mesh/mesh.hpp"

namespace sprekk::mesh::testing {

inline std::vector<int> sum_over_ranks(const Comm& comm, const std::vector<int>& mine) {
  std::vector<int> sum(mine.size());
  Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, static_cast<int>(mine.size()), mine.data(), sum.data());
  return sum;
}

inline void expect_one_owner_each(const GlobalMesh& global, const Mesh& mesh) {
  std::vector<int> cell_owners(global.n_cells()), node_owners(global.n_nodes()),
      face_owners(global.fracture_faces.size());
  for (LocalIndex c = 0; c < mesh.n_owned_cells; ++c) ++cell_owners[mesh.cell_id[c]];
  for (LocalIndex n = 0; n < mesh.n_owned_nodes; ++n) ++node_owners[mesh.node_id[n]];
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) ++face_owners[mesh.fracture_faces[f].id];
  for (const auto& owners : {cell_owners, node_owners, face_owners})
    EXPECT_EQ(sum_over_ranks(*mesh.comm, owners), std::vector<int>(owners.size(), 1));
}

/// Checks all documented properties of Mesh by brute force on the global mesh. Collective.
inline void expect_as_documented(const GlobalMesh& global, const std::vector<int>& part, const Mesh& mesh) {
  const int rank = mesh.comm->getRank(), dim = global.dim(), npc = n_nodes(global.shape),
            nfn = n_face_nodes(global.shape);
  expect_one_owner_each(global, mesh);  // first, because it is collective and the assertions below may return
  const auto nodes_of = [&](GlobalIndex c) {
    return std::set<GlobalIndex>(&global.cells[c * npc], &global.cells[c * npc] + npc);
  };

  std::set<GlobalIndex> owned_cells, near, cells, nodes;
  for (GlobalIndex c = 0; c < global.n_cells(); ++c)
    if (part[c] == rank) {
      owned_cells.insert(c);
      for (auto n : nodes_of(c)) near.insert(n);
    }
  for (GlobalIndex c = 0; c < global.n_cells(); ++c)
    for (auto n : nodes_of(c))
      if (near.count(n)) cells.insert(c);
  for (const auto& f : global.fracture_faces)
    if (part[f.cell[minus]] == rank) cells.insert(f.cell[plus]);
  const auto points_of = [&](const auto& face) {  // coordinates of corners: the sides have separate nodes at equal
                                                  // points
    std::set<std::vector<Real>> points;
    for (int k = 0; k < n_face_corners(global.shape); ++k) {
      const auto x = point(global, nodes_of_face(global, face.cell[minus], face.local_face[minus])[k]);
      points.insert({x[0], x[1], x[2]});
    }
    return points;
  };
  for (const auto& f : global.fracture_faces)  // cells at faces that share a point with an owned face
    for (const auto& other : global.fracture_faces) {
      if (part[f.cell[minus]] != rank) continue;
      int shared = 0;
      const auto points = points_of(f);
      for (const auto& x : points_of(other)) shared += points.count(x);
      if (shared > 0) cells.insert(other.cell[minus]);
    }
  for (auto c : cells)
    for (auto n : nodes_of(c)) nodes.insert(n);

  ASSERT_EQ(mesh.n_owned_cells, static_cast<LocalIndex>(owned_cells.size()));
  EXPECT_TRUE(std::equal(owned_cells.begin(), owned_cells.end(), mesh.cell_id.begin()));
  EXPECT_EQ(std::set<GlobalIndex>(mesh.cell_id.begin(), mesh.cell_id.end()), cells);
  EXPECT_EQ(mesh.cell_id.size(), cells.size());
  EXPECT_EQ(std::set<GlobalIndex>(mesh.node_id.begin(), mesh.node_id.end()), nodes);
  EXPECT_EQ(mesh.node_id.size(), nodes.size());
  ASSERT_EQ(mesh.coordinates.size(), mesh.node_id.size() * dim);
  ASSERT_EQ(mesh.cells.size(), mesh.cell_id.size() * npc);

  for (LocalIndex c = 0; c < mesh.n_cells(); ++c) {
    EXPECT_EQ(mesh.cell_owner[c], part[mesh.cell_id[c]]);
    EXPECT_EQ(mesh.cell_region[c], global.cell_region[mesh.cell_id[c]]);
    for (int k = 0; k < npc; ++k)
      EXPECT_EQ(mesh.node_id[mesh.cells[c * npc + k]], global.cells[mesh.cell_id[c] * npc + k]);
  }
  for (LocalIndex n = 0; n < mesh.n_nodes(); ++n) {
    for (int i = 0; i < dim; ++i)
      EXPECT_EQ(mesh.coordinates[n * dim + i], global.coordinates[mesh.node_id[n] * dim + i]);
    int owner = mesh.comm->getSize();
    for (GlobalIndex c = 0; c < global.n_cells(); ++c)
      if (nodes_of(c).count(mesh.node_id[n])) owner = std::min(owner, part[c]);
    EXPECT_EQ(owner == rank, n < mesh.n_owned_nodes);
  }

  std::set<GlobalIndex> expected_faces;
  for (std::size_t f = 0; f < global.fracture_faces.size(); ++f)
    for (auto c : global.fracture_faces[f].cell)
      if (cells.count(c)) expected_faces.insert(f);
  EXPECT_EQ(mesh.fracture_faces.size(), expected_faces.size());
  for (LocalIndex f = 0; f < mesh.n_fracture_faces(); ++f) {
    const auto& face = mesh.fracture_faces[f];
    const auto& original = global.fracture_faces.at(face.id);
    EXPECT_TRUE(expected_faces.count(face.id));
    EXPECT_EQ(face.fracture, original.fracture);
    EXPECT_EQ(face.local_face, original.local_face);
    EXPECT_EQ(part[original.cell[minus]] == rank, f < mesh.n_owned_fracture_faces);
    for (int side : {minus, plus}) {
      const bool present = cells.count(original.cell[side]);
      ASSERT_EQ(face.cell[side] >= 0, present);
      EXPECT_EQ(present ? mesh.cell_id[face.cell[side]] : original.cell[side], original.cell[side]);
      EXPECT_TRUE(present || f >= mesh.n_owned_fracture_faces);
      std::set<GlobalIndex> found, wanted;
      for (int k = 0; k < max_face_nodes; ++k) {
        ASSERT_EQ(face.nodes[side][k] >= 0, present && k < nfn);
        if (face.nodes[side][k] >= 0) found.insert(mesh.node_id[face.nodes[side][k]]);
      }
      for (auto n : nodes_of_face(global, original.cell[side], original.local_face[side]))
        if (present && n >= 0) wanted.insert(n);
      EXPECT_EQ(found, wanted);
    }
    for (int k = 0; k < nfn && face.cell[minus] >= 0 && face.cell[plus] >= 0; ++k)
      for (int i = 0; i < dim; ++i)
        EXPECT_EQ(mesh.coordinates[face.nodes[minus][k] * dim + i], mesh.coordinates[face.nodes[plus][k] * dim + i]);
  }

  std::multiset<std::array<GlobalIndex, 4>> boundary, expected_boundary;
  for (const auto& f : mesh.boundary_faces)
    boundary.insert({f.boundary, mesh.cell_id[f.cell], f.local_face, f.owned ? 1 : 0});
  for (const auto& f : global.boundary_faces)
    if (cells.count(f.cell)) expected_boundary.insert({f.boundary, f.cell, f.local_face, part[f.cell] == rank ? 1 : 0});
  EXPECT_EQ(boundary, expected_boundary);

  EXPECT_EQ(mesh.n_global_cells, global.n_cells());
  EXPECT_EQ(mesh.n_global_nodes, global.n_nodes());
  EXPECT_EQ(mesh.n_global_fracture_faces, static_cast<GlobalIndex>(global.fracture_faces.size()));
  EXPECT_EQ(mesh.boundary_names, global.boundary_names);
  EXPECT_EQ(mesh.fracture_names, global.fracture_names);
  EXPECT_EQ(mesh.region_names, global.region_names);
}

/// Checks that all members are bitwise equal.
inline void expect_identical(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.comm, b.comm);
  const auto plain = [](const Mesh& m) {
    return std::tie(m.shape, m.n_owned_nodes, m.n_owned_cells, m.n_owned_fracture_faces, m.n_free_nodes, m.tied_to,
                    m.node_id, m.cell_id, m.cell_owner, m.coordinates, m.cells, m.cell_region, m.cell_piece,
                    m.region_names, m.boundary_names, m.fracture_names, m.n_global_nodes, m.n_global_cells,
                    m.n_global_fracture_faces, m.n_pieces, m.tip, m.enriched, m.enriched_id, m.n_owned_enriched,
                    m.n_global_enriched);
  };
  EXPECT_TRUE(plain(a) == plain(b));
  const auto plain_report = [](const PartitionReport& r) {
    return std::tie(r.cells, r.fracture_faces, r.cell_imbalance, r.fracture_face_imbalance, r.edge_cut,
                    r.separated_faces);
  };
  EXPECT_TRUE(plain_report(a.partition) == plain_report(b.partition));
  ASSERT_EQ(a.fracture_faces.size(), b.fracture_faces.size());
  const auto plain_face = [](const Mesh::FractureFace& f) {
    return std::tie(f.id, f.fracture, f.cell, f.local_face, f.nodes, f.corners, f.area, f.centre, f.frame);
  };
  for (std::size_t f = 0; f < a.fracture_faces.size(); ++f)
    EXPECT_TRUE(plain_face(a.fracture_faces[f]) == plain_face(b.fracture_faces[f]));
  ASSERT_EQ(a.boundary_faces.size(), b.boundary_faces.size());
  for (std::size_t f = 0; f < a.boundary_faces.size(); ++f) {
    const auto &x = a.boundary_faces[f], &y = b.boundary_faces[f];
    EXPECT_TRUE(std::tie(x.boundary, x.cell, x.local_face, x.owned) ==
                std::tie(y.boundary, y.cell, y.local_face, y.owned));
  }
}

}  // namespace sprekk::mesh::testing
