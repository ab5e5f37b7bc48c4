// A scene: everything that a run needs to know, as the XML file or a host application gives it.
#pragma once

#include "base/expression.hpp"
#include "base/parameters.hpp"
#include "base/table.hpp"
#include "laws/elasticity.hpp"
#include "mesh/box.hpp"
#include "physics/elastic_plastic_jump.hpp"
#include "solve/newton.hpp"
#include "solve/time_stepping.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::model {

/// Rock, or the surface of a fracture.
struct Material {
  std::string type;  ///< "elastic" or "joint"

  laws::ElasticPair elastic;

  Real tangential_stiffness = std::numeric_limits<Real>::infinity();
  std::optional<Real> friction_coefficient, friction_angle;  ///< exactly one for a joint
  Real dilation_angle = 0, initial_gap = 0, maximum_closure = 0, initial_aperture = 0;
  std::optional<Real> normal_stiffness;  ///< needed where there is closure

  void describe(base::Section& section);
  physics::JointParameters joint() const;
};

struct Bulk {
  std::string material;
  std::vector<base::Expression> body_force;
  void describe(base::Section& section);
};

struct Fracture {
  std::string material;
  void describe(base::Section& section);
};

struct BoundaryCondition {
  std::string boundary;
  std::vector<base::Expression> displacement;  ///< per component; the text "free" leaves one free
  std::vector<base::Expression> traction;
  void describe(base::Section& section);
};

struct Time {
  Real start = 0, end = 1;
  int steps = 1;
  std::optional<std::vector<Real>> schedule;
  solve::TimeSteppingOptions stepping;
  void describe(base::Section& section);
  std::vector<Real> times() const;  ///< the ends of all steps
};

struct Output {
  bool vtu = true;
  int every = 1;  ///< steps
  void describe(base::Section& section);
};

struct Scene {
  mesh::BoxMesh mesh;
  std::map<std::string, Material> materials;
  Bulk bulk;
  std::map<std::string, Fracture> fractures;
  std::map<std::string, BoundaryCondition> boundary_conditions;
  base::Tables tables;
  Time time;
  solve::NewtonOptions solver;
  Output output;

  void describe(base::Section& section);
  int dim() const { return static_cast<int>(mesh.lower_corner.size()); }

 private:
  void check_names(base::Section& section) const;
};

/// Reads a scene file, applies overrides "Path.To.Entry=value", checks everything that can be checked without running,
/// and makes the expressions ready. Throws one Error with a line for each thing that is wrong. Collective.
Scene read_scene(const Comm& comm, const std::string& path, const std::vector<std::string>& overrides = {});

}  // namespace sprekk::model
