// Mechanics of fractured rock: scene entries and modules.
#pragma once

#include "base/expression.hpp"
#include "fields/properties.hpp"
#include "laws/elasticity.hpp"
#include "laws/joint_material.hpp"
#include "physics/mechanics/loads.hpp"
#include "physics/mechanics/prescribed_slip.hpp"
#include "physics/physics.hpp"

#include <optional>
#include <string>
#include <vector>

namespace sprekk::physics {

Real usual_augmentation();  ///< default of ElasticPlasticJumpParameters

/// Initial stress of rock at rest under gravity along the last coordinate.
struct Lithostatic {
  Real surface = 0;           ///< coordinate where the vertical stress is zero, m
  Real horizontal_ratio = 1;  ///< ratio of horizontal to vertical stress
  void describe(base::Section& section);
};

/// Initial stress with vertical and horizontal principal directions, compression positive, linear in the depth below a
/// datum. In 3D x is east, y north and z up. In 2D x is east and y up (a vertical section).
struct PrincipalStress {
  struct Component {
    Real value = 0, gradient = 0;  ///< at the datum, Pa; per metre of depth, Pa/m
  };
  Real datum = 0;  ///< vertical coordinate, m
  Component vertical, largest, smallest;
  Real azimuth = 90;  ///< of the largest horizontal stress, degrees clockwise from north
  void describe(base::Section& section);
  /// Components XX, YY, ZZ, XY in 2D; XX, YY, ZZ, XY, YZ, XZ in 3D; tension positive.
  std::vector<base::Expression> stress(int dim) const;
};

struct Mechanics : Physics<Mechanics> {
  /// Elastic constants and density of rock. Every value may be an expression of x, y, z.
  struct Rock : Physics::Rock {
    std::optional<base::Expression> E, nu, G, lambda, K;  ///< exactly two are given
    std::optional<base::Expression> density;              ///< required with gravity
    void describe(base::Section& section);
    void check(base::Section& section) const;
    bool has_elasticity() const { return E || nu || G || lambda || K; }
    bool is_uniformly_elastic() const;  ///< no value depends on the position
    /// Law at a point. Throws an Error with entry, value and point if a value is out of range.
    laws::Elasticity elasticity(const std::array<Real, 3>& x) const;
    Real density_at(const std::array<Real, 3>& x) const;  ///< throws the same errors; requires a density
  };

  struct Joint : Physics::Joint, laws::JointMaterial {
    void describe(base::Section& section);
    void check(base::Section& section) const { compare_entries(section); }
  };

  struct Bulk : Physics::Bulk {
    bool rigid = false;  ///< the rock does not deform; no mechanics
    std::vector<base::Expression> body_force;
    std::vector<base::Expression> initial_stress;   ///< XX, YY, ZZ, XY in 2D; XX, YY, ZZ, XY, YZ, XZ in 3D
    std::optional<Lithostatic> lithostatic_stress;  ///< or this
    std::optional<PrincipalStress> in_situ_stress;  ///< or this
    std::vector<Real> release;                      ///< begin and end, s, see make_release(); empty: none
    void describe(base::Section& section);
    void check(base::Section& section) const;
  };

  struct Region : Physics::Region {
    std::vector<base::Expression> initial_stress;
    void describe(base::Section& section);
    bool is_given() const { return !initial_stress.empty(); }
  };

  struct Fracture : Physics::Fracture {
    base::Expression fluid_pressure = 0;
    std::vector<base::Expression> plastic_jump;      ///< initial tangential plastic jump in the face frame, m
    std::optional<base::Expression> slip_path;       ///< path length of the initial slip, m; of joints in situ
    std::vector<base::Expression> initial_traction;  ///< of the contact in the face frame, Pa; empty: as in the rock
    std::optional<PrescribedSlip> prescribed_slip;
    std::optional<base::Expression> unbroken;   ///< above 0: bonded at the start, see unbroken.hpp
    bool stress_intensity = false;              ///< table of StressIntensity
    std::optional<base::Expression> toughness;  ///< Pa m^0.5; the table then has directions of growth
    std::optional<base::Expression> strength;   ///< Pa, tensile, of the rock beyond fractures that the tips meet
    void describe(base::Section& section);
  };

  struct BoundaryCondition : Physics::BoundaryCondition {
    static constexpr const char* kinds =
        "either \"displacement\", or \"traction\", \"confining pressure\", \"foundation stiffness\" or several of "
        "these";
    std::vector<base::Expression> displacement;    ///< per component; the text "free" leaves a component free
    std::vector<Real> lower_corner, upper_corner;  ///< displacements only at nodes in this box; empty: all nodes
    std::vector<base::Expression> traction;
    std::optional<base::Expression> confining_pressure;  ///< along the inward normal
    std::vector<Real> foundation_stiffness;              ///< of springs to rigid ground, per direction
    void describe(base::Section& section);
    void check(base::Section& section) const;
    bool is_loaded() const { return !traction.empty() || confining_pressure; }
    bool is_given() const { return !displacement.empty() || is_loaded() || !foundation_stiffness.empty(); }
    std::vector<Prescribed> prescribed() const;
  };

  struct Sections : Physics::Sections {
    /// Value for ElasticPlasticJumpParameters. It is not an entry, since it does not affect solutions.
    Real augmentation = usual_augmentation();
    /// Not an entry: elastic constants or springs of a live model have changed, or a region was filled.
    bool keeps_stress = false;
    void keep(const Sections& other) {
      augmentation = other.augmentation;
      keeps_stress = other.keeps_stress;
    }
  };

  static bool is_in(const Scene& scene);
  static Facets needs_facets(const Scene& scene);
  static std::vector<std::string> fixed_entries();
  static void compare(Comparison& comparison);
  static void compare_mesh(Comparison& comparison, const mesh::GlobalMesh& mesh);
  static void add_modules(const Setting& setting, Modules& modules);
  static std::vector<std::string> warnings(const Setting& setting);

  struct Estimate {
    static std::string missing(const Scene& scene);
    static std::vector<estimate::QuantityKind> quantities();
    static std::string refuses(const Scene& scene, const estimate::Functional& J);
    static std::unique_ptr<estimate::MeshError> mesh_error(const Setting& setting, assembly::System& system);
  };
  struct Change {
    static std::vector<std::string> refuses(const Scene& before, const Scene& after);
    static std::vector<std::string> refuses_in(const mesh::Mesh& mesh, const Scene& before, const Scene& after);
    static void prepare(const mesh::Mesh& whole, const Scene& before, Scene& after);
  };
  struct Warnings {
    static std::vector<std::string> of_input(const Setting& setting, const std::vector<Real>& times);
    static std::vector<std::string> of_state(const Setting& setting, const std::vector<Real>& times,
                                             const std::vector<assembly::OutputField>& outputs);
  };
  struct Log {
    static std::vector<LogColumn> columns(const Setting& setting);
  };
  struct Events {
    static EventSource source();
  };
  struct Tables {
    static std::string name();
    static std::unique_ptr<estimate::TableOfStates> table(const Setting& setting, assembly::System& system);
  };
  struct Solvability {
    static std::vector<std::string> doubts(const Setting& setting, bool oscillates);
  };
};

/// Elasticity of local cells.
fields::Properties<laws::Elasticity> elasticity(const Scene& scene, const mesh::Mesh& mesh);

/// Returns whether the scene has a "solid pressure" for displacements of an order; 1: of any order. Not available if
/// another physics has unknowns on facets, because the facet bubbles would have to include its stress.
bool has_solid_pressure(const Scene& scene, int order = 1);

/// Regions with changed rock in a changed scene, by name: true if filled, false if the elastic constants differ.
/// Collective.
std::map<std::string, bool> changed_rock(const mesh::Mesh& mesh, const Scene& before, const Scene& after);

/// Largest Young's modulus, Pa. Collective.
Real largest_modulus(const Scene& scene, const mesh::Mesh& mesh);

/// Body force and gravity of the scene.
BodyForce body_force(const Scene& scene, const mesh::Mesh& mesh);

/// Initial stress of the scene: given, lithostatic or in-situ. A region may have its own.
InitialStress initial_stress(const Scene& scene, const mesh::Mesh& mesh);

/// Initial state of an owned fracture face.
struct StartOfFace {
  std::array<Real, 3> traction;  ///< in its frame, Pa; zero without initial stress
  Real bound;                    ///< shear bound of the joint, Pa
  bool depends_on_rate;          ///< the bound is that of the initial slip rate
  Real unloaded_aperture;        ///< a0 of (15), m
  Real opening;                  ///< normal jump w_0, m; zero without initial stress
  Real least_opening;            ///< see laws::least_opening(), m
  Real overlap;                  ///< of a joint in situ: laws::overlap_compression(), Pa; otherwise infinite
  Real smaller_aperture;         ///< of a joint in situ: laws::smaller_aperture(), m; otherwise 0
  Real cohesive_zone;            ///< of a rupture, m, see laws::cohesive_zone()
  /// Widening by a pressure that varies along the fracture, m/Pa: C = C_j/(1 + C_j E'/(4 h)), with the compliance C_j
  /// of the joint, the plane-strain modulus E' of the rock at side - and the size h of the face. E'/(4 h) is the
  /// stiffness of the rock under a pressure cos(x/h).
  Real compliance;
};
/// Initial states of all owned fracture faces. Collective.
std::vector<StartOfFace> starts_of_faces(const Setting& setting);

/// Gap g0 of (14), [owned fracture face]; null if it is constant on the fracture.
std::vector<const base::Expression*> varying_gaps(const Scene& scene, const mesh::Mesh& mesh);

}  // namespace sprekk::physics
