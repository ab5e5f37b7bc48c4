// A scene: everything that a run needs to know, as the XML file or a host application gives it.
#pragma once

#include "base/expression.hpp"
#include "base/parameters.hpp"
#include "base/table.hpp"
#include "laws/darcy.hpp"
#include "laws/elasticity.hpp"
#include "mesh/box.hpp"
#include "mesh/mesh.hpp"
#include "model/network.hpp"
#include "physics/mechanics/joint_material.hpp"
#include "physics/flow/fracture_flow.hpp"
#include "solve/newton.hpp"
#include "solve/time_stepping.hpp"

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::model {

/// Rock, or the surface of a fracture. Every number may be an expression of x, y, z.
struct Material : physics::JointMaterial {
  std::string type;                   ///< "elastic" or "joint"
  std::optional<std::string> source;  ///< where the values come from

  std::optional<Value> E, nu, G, lambda, K;  ///< exactly two for rock
  std::optional<Value> density;              ///< needed with gravity
  std::vector<Value> permeability;           ///< one value, or those of a tensor; needed with flow
  Real porosity = 0, biot = 1;               ///< of rock; Biot's coefficient
  /// Of the pores; Biot's modulus. At most one.
  std::optional<Real> compressibility, biot_modulus;

  Value residual_aperture = 0;
  std::optional<Value> tangential_permeability;  ///< absent: the cubic law
  Value normal_permeability = std::numeric_limits<Real>::infinity();

  void describe(base::Section& section);
  bool is_uniform() const;  ///< no value depends on the place
  /// The law at a point. Throws an Error that names the entry, the value and the point where a value is out of range.
  laws::Elasticity elasticity(const Point& x) const;
  bool flows_uniformly() const;  ///< the permeability of rock does not depend on the place
  /// k/mu of the flow through rock. Throws an Error where k is no positive definite tensor of that dimension.
  laws::Mobility mobility(int dim, Real viscosity, const Point& x) const;
  /// How the porosity grows with the pressure at constant strain, 1/Pa, where the fluid has this compressibility.
  Real growth_of_pores(Real of_fluid) const;
  /// Of the flow in and through a joint with sides at rest.
  physics::FractureFlowParameters::Face hydraulics(Real viscosity, const Point& x) const;

 private:
  /// Calls visit(name, value, least, least itself is allowed, upper limit) for each of the values that are given.
  template <class Visit>
  void for_each(const Visit& visit) const;
  void check(const Point& x) const;
};

/// Initial stress of rock at rest under gravity along the last coordinate.
struct Lithostatic {
  Real surface = 0;           ///< coordinate where the vertical stress is zero, m
  Real horizontal_ratio = 1;  ///< horizontal over vertical stress
  void describe(base::Section& section);
};

struct Bulk {
  std::string material;  ///< of all regions that have none of their own
  std::vector<base::Expression> body_force;
  std::vector<Real> gravity;                      ///< m/s^2; its force is the density times this
  std::vector<base::Expression> initial_stress;   ///< XX, YY, ZZ, XY in 2D; XX, YY, ZZ, XY, YZ, XZ in 3D
  std::optional<Lithostatic> lithostatic_stress;  ///< or this
  void describe(base::Section& section);
};

/// A mesh from a file of gmsh instead of a box.
struct MeshFile {
  struct Fracture {
    std::optional<std::vector<Real>> reference_normal;
    bool swap_sides = false;
    void describe(base::Section& section);
  };
  std::string path;                           ///< relative to the scene's file; of a host, to the current directory
  std::optional<Network> network;             ///< that the mesh was made of; its sets are fractures
  std::optional<int> order;                   ///< of the cells, 1 or 2; absent: as in the file
  int refinements = 0;                        ///< see mesh::describe_refinements()
  std::string tips = "enriched";              ///< see mesh::describe_tips()
  std::vector<std::string> periodic;          ///< boundaries in pairs, see mesh::tie_periodic()
  std::map<std::string, Fracture> fractures;  ///< the physical groups that are fractures
  void describe(base::Section& section);
};

/// A line from which fluid flows into the rock, or back.
struct Well {
  std::vector<Real> points;  ///< 2D: one; 3D: of a polyline
  Real radius = 0, skin = 0;
  std::optional<base::Expression> rate, pressure;  ///< exactly one
  void describe(base::Section& section);
};

/// A fluid that flows through the rock.
struct Flow {
  bool rigid_rock = false;  ///< the rock does not deform: no mechanics
  Real viscosity = 1e-3, density = 1000, compressibility = 0, reference_pressure = 0;
  base::Expression source = 0, initial_pressure = 0;
  std::string scheme = "auto";
  std::map<std::string, Well> wells;
  void describe(base::Section& section);
};

/// A fluid of a host's in the pores and fractures of rock that deforms, instead of Flow. Of materials, "Biot
/// coefficient" counts, of joints the aperture.
struct HostFluid {
  /// The host's modules declare the unknowns "pressure" (cells) and "face pressure" (facets, see mesh::Facets) and
  /// write their rows, the balance of volume per time; what displacements add to them, and they to momentum, is
  /// Sprekk's, see physics::make_poroelastic_coupling(). If not, the host gives pressures: Model::set_fluid_pressure().
  bool unknown = false;
  Real initial_pressure = 0;  ///< under which the initial state is one of rest, Pa
};

/// What a part of the rock has of its own, in place of what Bulk says.
struct Region {
  std::optional<std::string> material;
  std::vector<base::Expression> initial_stress;
  std::optional<base::Expression> pressure;  ///< of the fluid, at all times
  void describe(base::Section& section);
};

struct Fracture {
  std::string material;
  base::Expression fluid_pressure = 0;
  base::Expression source = 0;                 ///< of fluid
  std::vector<std::string> cuts;               ///< names of fractures that its filling divides
  std::vector<base::Expression> plastic_jump;  ///< tangential, at the start, in the frame of the face
  void describe(base::Section& section);
};

struct BoundaryCondition {
  std::string boundary;
  std::optional<std::string> region;           ///< only where the boundary touches this region
  std::vector<base::Expression> displacement;  ///< per component; the text "free" leaves one free
  std::vector<base::Expression> traction;
  std::optional<base::Expression> pressure, flux, conductance;  ///< of the fluid
  std::optional<std::string> fracture;                          ///< of these: only where this fracture ends here
  void describe(base::Section& section);
};

struct Time {
  Real start = 0, end = 1;
  int steps = 1;
  std::optional<std::vector<Real>> schedule;
  std::string scheme = "implicit Euler";  ///< or BDF2, of rates of what is stored
  solve::TimeSteppingOptions stepping;
  void describe(base::Section& section);
  std::vector<Real> times() const;  ///< the ends of all steps
};

/// When a run writes a checkpoint: whatever comes first, and after the last step.
struct CheckpointTimes {
  std::optional<int> steps;
  std::optional<Real> minutes;  ///< of the wall clock
  void describe(base::Section& section);
};

struct Output {
  bool vtu = true;
  int every = 1;  ///< steps
  bool error_estimate = false;
  std::optional<CheckpointTimes> checkpoints;
  void describe(base::Section& section);
};

struct Scene {
  std::string origin = "scene";  ///< opens messages about it: the file that it was read from
  mesh::BoxMesh mesh;
  std::optional<MeshFile> mesh_file;  ///< used instead of `mesh` if it is there
  std::map<std::string, Material> materials;
  Bulk bulk;
  std::optional<Flow> flow;
  std::optional<HostFluid> host_fluid;  ///< not an entry
  std::map<std::string, Region> regions;
  std::map<std::string, Fracture> fractures;
  std::map<std::string, BoundaryCondition> boundary_conditions;
  base::Tables tables;
  base::Expression::Named expressions;  ///< that others call by name
  Time time;
  solve::NewtonOptions solver;
  Output output;
  /// Of physics::ElasticPlasticJumpParameters; not an entry, for it has no influence on solutions.
  Real augmentation = physics::ElasticPlasticJumpParameters().augmentation;

  void describe(base::Section& section);
  /// The global mesh of either kind; if it is to be refined, as refined() takes it. Not collective.
  mesh::GlobalMesh make_mesh() const;
  /// What is left to do once make_mesh() has been distributed: refinement, and what comes after it. Collective.
  RCP<const mesh::Mesh> refined(RCP<const mesh::Mesh> mesh) const;
  mesh::GlobalMesh read_mesh() const;  ///< without what is done about crack tips
  int refinements() const;             ///< of the mesh that is used
  const std::string& tips() const;     ///< the same
  const Material& material_of(const std::string& region) const;
  bool has_unknown_pressure() const { return flow || (host_fluid && host_fluid->unknown); }
  base::Expression initial_pressure() const;  ///< of the fluid in rock and fractures; 0 without
  bool deforms() const { return !flow || !flow->rigid_rock; }
  /// As given, or the lithostatic one; of a region its own, where it has one.
  physics::InitialStress initial_stress(const std::vector<std::string>& region_names) const;
  physics::FluidPressure fluid_pressure(const std::vector<std::string>& fracture_names) const;
};

/// The scene as a Model uses it: checked as if it had been read from a file, materials of the library added,
/// expressions made ready; and what is wrong with its entries. What holds for one that was read does not change. Not
/// collective.
base::Draft<Scene> prepared(const Scene& scene);

/// Reads a scene file, applies overrides "Path.To.Entry=value", checks its entries, and makes the expressions ready.
/// Where an entry is wrong, the mesh is made to check the rest as well; throws one Error with a line for each thing
/// that is wrong, see checked_mesh(). Collective.
Scene read_scene(const Comm& comm, const std::string& path, const std::vector<std::string>& overrides = {});

}  // namespace sprekk::model
