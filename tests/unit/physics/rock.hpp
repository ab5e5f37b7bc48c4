// Small fractured domains as equation systems, with their blocks as dense matrices.
#pragma once

#include <Tpetra_Core.hpp>
#include <memory>
#include <string>
#include <vector>

#include "assembly/system.hpp"
#include "mesh/distribute.hpp"
#include "mesh/facets.hpp"
#include "physics/mechanics/modules.hpp"
#include "unit/assembly/dense.hpp"
#include "unit/mesh/meshes.hpp"

namespace sprekk::physics::testing {

using mesh::testing::all_cells;
using mesh::testing::fracture;
using test::Dense;

inline constexpr laws::Elasticity soft{1, 1.5}, stiff{4, 2};

inline base::Expression text(const std::string& formula) {
  base::Expression e(formula);
  e.compile();
  return e;
}

struct Loads {
  std::vector<base::Expression> body_force;
  std::vector<BoundaryTraction> tractions;
};

/// Mesh and the equations on it.
struct Rock {
  mesh::GlobalMesh global;
  RCP<const mesh::Mesh> mesh;
  std::vector<laws::Elasticity> elasticity;  ///< [region]
  laws::JointParameters joint;
  std::unique_ptr<assembly::System> system;

  int dim() const { return mesh->dim(); }

  /// Returns the global block (row, column) of the Jacobian, equal on every rank. Collective.
  Dense block(int row, int column) const { return test::gather(*system->matrix()(row, column)); }

  /// Sets x[block] at a global unknown, on the rank that owns it.
  static void set(fields::BlockVector& x, int block, GlobalIndex unknown, Real value) {
    if (x[block]->getMap()->isNodeGlobalElement(unknown)) x[block]->replaceGlobalValue(unknown, value);
  }

  /// Sets the displacement of every owned node n to u(coordinates of n, component).
  template <class Function>
  void displace(fields::BlockVector& x, const Function& u) const {
    for (LocalIndex n = 0; n < mesh->n_owned_nodes; ++n)
      for (int i = 0; i < dim(); ++i) x[0]->replaceLocalValue(n * dim() + i, u(&mesh->coordinates[n * dim()], i));
  }

  /// Returns the output `name` of the owned fracture faces of this rank.
  std::vector<Real> output(const fields::BlockVector& x, const std::string& name) const {
    for (const auto& field : system->outputs(x))
      if (field.name == name) return field.values;
    throw Error("no output " + name);
  }
};

/// Returns the system of the bulk alone if the mesh has no fracture, else of all three modules. Cells of region 1 are
/// stiff, of region 0 soft.
inline Rock make_rock(mesh::GlobalMesh global, const laws::JointParameters& joint = {}, const Loads& loads = {},
                      RCP<const Comm> comm = Tpetra::getDefaultComm(),
                      const std::vector<assembly::DirichletCondition>& conditions = {}) {
  global.region_names = {"soft", "stiff"};
  Rock rock{global, mesh::make_distributed(global, comm), {soft, stiff}, joint, nullptr};
  const MechanicsParameters mechanics{
      .bulk = {.elasticity = {rock.elasticity}, .body_force = {loads.body_force}, .tractions = loads.tractions},
      .joints = {std::vector<laws::JointParameters>(global.fracture_names.size(), joint)}};
  rock.system = std::make_unique<assembly::System>(rock.mesh, make_mechanics(*rock.mesh, mechanics), conditions,
                                                   rcp(new base::Timers));
  rock.system->set_time(1, 1);
  return rock;
}

/// Returns a box of 2 x 2 [x 2] unit squares or cubes, cut by the plane y = 1 ("a") and, if `crossing`, x = 1 ("b").
/// The box is turned by 20 degrees. Rock above y = 1 is stiff.
inline mesh::GlobalMesh cut_box(const std::string& cell, bool crossing) {
  const bool flat = mesh::testing::dim_of(cell) == 2;
  auto box = mesh::testing::unit_steps(cell, std::vector<int>(flat ? 2 : 3, 2));
  box.fractures["a"] = flat ? fracture({0, 1}, {2, 1}) : fracture({0, 1, 0}, {2, 1, 2});
  if (crossing) box.fractures["b"] = flat ? fracture({1, 0}, {1, 2}) : fracture({1, 0, 0}, {1, 2, 2});
  auto level = mesh::make_box(box);
  std::vector<int> region;
  for (GlobalIndex c = 0; c < level.n_cells(); ++c) region.push_back(mesh::testing::cell_centre(level, c)[1] > 1);
  box.rotation = 20;
  auto turned = mesh::make_box(box);
  turned.cell_region = region;
  return turned;
}

inline bool on_simplices(const mesh::GlobalMesh& mesh) {
  return mesh.shape == mesh::Shape::triangle || mesh.shape == mesh::Shape::tetrahedron;
}

}  // namespace sprekk::physics::testing
