// Floating blocks for prescribed contact constraints: a column of three blocks along y, cut by "lower" and "upper".
#pragma once

#include "contact/floating_pieces.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <map>

#include "unit/assembly/fake_modules.hpp"

namespace sprekk::test {

using contact::Constraint;
using contact::FloatingPieces;
using contact::RigidFrame;
using contact::RigidRow;
using mesh::Vector;
using mesh::testing::all_cells;
using mesh::testing::dim_of;

inline mesh::BoxMesh column_box(const std::string& cell, int width = 2) {
  const bool flat = dim_of(cell) == 2;
  auto box = mesh::testing::unit_steps(cell, flat ? std::vector<int>{width, 3} : std::vector<int>{width, 3, width});
  for (const auto& [name, y] : std::map<std::string, Real>{{"lower", 1}, {"upper", 2}}) {
    std::vector<Real> from{0, y, 0}, to{Real(width), y, Real(width)};
    from.resize(dim_of(cell)), to.resize(dim_of(cell));
    box.fractures[name] = mesh::testing::fracture(from, to);
  }
  return box;
}

/// Contact constraint between the sides of a fracture.
struct Contact {
  enum { open, slip, stick } state = open;
  Vector along = {1, 0, 0};  ///< direction of slip
};
inline const Contact open{}, stick{Contact::stick}, slip{Contact::slip};

struct Column {
  RCP<const mesh::Mesh> mesh;
  fields::Layout layout;
  assembly::Constraints constraints;
  FloatingPieces pieces;
  RCP<fields::Vector> diagonal;

  Column(const mesh::BoxMesh& box, const std::vector<std::string>& constrained)
      : mesh(mesh::make_distributed(mesh::make_box(box), Tpetra::getDefaultComm())),
        layout({"displacement", fields::Entity::node, mesh->dim(), "m"}, *mesh),
        constraints(*mesh, layout, conditions(*mesh, constrained)),
        pieces(mesh, layout, constraints.supports(), assembly::cell_volumes(*mesh)),
        diagonal(rcp(new fields::Vector(layout.owned()))) {
    diagonal->putScalar(7);
    if (pieces.possible()) pieces.set_stiffness(*diagonal);
  }

  static std::vector<assembly::DirichletCondition> conditions(const mesh::Mesh& mesh,
                                                              const std::vector<std::string>& constrained) {
    std::vector<assembly::DirichletCondition> all;
    for (const auto& boundary : constrained) all.push_back(constrain(mesh, boundary, boundary, {0.0, 0.0, 0.0}));
    return all;
  }

  std::vector<Constraint> contact_constraints(const Contact& lower, const Contact& upper) const {
    std::vector<Constraint> all(mesh->n_owned_fracture_faces);
    for (LocalIndex f = 0; f < mesh->n_owned_fracture_faces; ++f) {
      const auto& contact = mesh->fracture_names[mesh->fracture_faces[f].fracture] == "lower" ? lower : upper;
      for (int i = 0; contact.state != Contact::open && i < mesh->dim(); ++i)
        for (int j = 0; j < mesh->dim(); ++j)
          all[f].constrained[i][j] = (i == j) - (contact.state == Contact::slip) * contact.along[i] * contact.along[j];
    }
    return all;
  }
  void find(const Contact& lower, const Contact& upper) { pieces.find(contact_constraints(lower, upper)); }

  Vector x(LocalIndex node) const {
    Vector result{};
    for (int i = 0; i < mesh->dim(); ++i) result[i] = mesh->coordinates[node * mesh->dim() + i];
    return result;
  }
  /// Returns the block (from below) of each owned node, by the adjacent cells.
  std::vector<int> block_of_node() const {
    std::vector<int> block(layout.n_owned_entities(), -1);
    const int n = mesh->nodes_per_cell();
    for (LocalIndex c = 0; c < mesh->n_cells(); ++c) {
      Real y = 0;
      for (int k = 0; k < n; ++k) y += x(mesh->cells[c * n + k])[1] / n;
      for (int k = 0; k < n; ++k)
        if (const auto node = mesh->free_node(mesh->cells[c * n + k]); node < layout.n_owned_entities())
          block[node] = static_cast<int>(y);
    }
    return block;
  }
  /// Returns a displacement that is a rigid motion q of each block; coordinates refer to the centre and the largest
  /// extent of the block.
  fields::Vector rigid(const std::array<RigidRow, 3>& q) const {
    fields::Vector u(layout.owned());
    const auto blocks = block_of_node();
    for (LocalIndex k = 0; k < layout.n_owned_entities(); ++k) {
      const auto v = rigid_displacement(frame(blocks[k]), q[blocks[k]], x(k));
      for (int i = 0; i < mesh->dim(); ++i) u.replaceLocalValue(k * mesh->dim() + i, v[i]);
    }
    return u;
  }
  RigidFrame frame(int block) const { return {{1, 0.5 + block, mesh->dim() == 3 ? 1.0 : 0.0}, 2}; }
  /// Returns the number of free motions. They are orthonormal in rigid coordinates, so it is the trace of the
  /// projection on them.
  Real n_motions() {
    if (!pieces.any()) return 0;
    Real trace = 0;
    for (int block = 0; block < 3; ++block)
      for (int mode : contact::rigid_modes(mesh->dim())) {
        std::array<RigidRow, 3> q{};
        q[block][mode] = 1;
        auto motion = fields::Vector(layout.owned());
        pieces.add(std::vector<Real>(pieces.n_groups(), 1), pieces.part_of(rigid(q)), motion);
        trace += coordinate(motion, block, mode);
      }
    return trace;
  }
  /// Returns a coordinate of a motion that is rigid in each block, by least squares for each mode. The modes of a
  /// block are orthogonal because these meshes are symmetric about the centres of blocks.
  Real coordinate(const fields::Vector& u, int block, int mode) const {
    std::array<RigidRow, 3> q{};
    q[block][mode] = 1;
    const auto unit = rigid(q);
    return unit.dot(u) / unit.dot(unit);
  }
};

}  // namespace sprekk::test
