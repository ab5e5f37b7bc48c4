// Mechanics of fractured rock: its entries of a scene and its modules.
#pragma once

#include "base/expression.hpp"
#include "laws/elasticity.hpp"
#include "physics/mechanics/joint_material.hpp"
#include "physics/mechanics/loads.hpp"
#include "physics/physics.hpp"
#include "physics/properties.hpp"

#include <optional>
#include <string>
#include <vector>

namespace sprekk::physics {

Real usual_augmentation();  ///< of ElasticPlasticJumpParameters

/// Initial stress of rock at rest under gravity along the last coordinate.
struct Lithostatic {
  Real surface = 0;           ///< coordinate where the vertical stress is zero, m
  Real horizontal_ratio = 1;  ///< horizontal over vertical stress
  void describe(base::Section& section);
};

/// Initial stress whose principal directions are the vertical and two horizontal ones; compression positive, linear in
/// the depth below a datum. In 3D x is east, y north, z up; in 2D x is east and y up, a vertical section.
struct PrincipalStress {
  struct Component {
    Real value = 0, gradient = 0;  ///< at the datum, Pa; per metre of depth, Pa/m
  };
  Real datum = 0;  ///< vertical coordinate, m
  Component vertical, largest, smallest;
  Real azimuth = 90;  ///< of the largest horizontal one, degrees clockwise from north
  void describe(base::Section& section);
  /// XX, YY, ZZ, XY in 2D; XX, YY, ZZ, XY, YZ, XZ in 3D; tension positive.
  std::vector<base::Expression> stress(int dim) const;
};

struct Mechanics : Physics<Mechanics> {
  /// Every number may be an expression of x, y, z.
  struct Rock : Physics::Rock {
    std::optional<base::Expression> E, nu, G, lambda, K;  ///< exactly two
    std::optional<base::Expression> density;              ///< needed with gravity
    void describe(base::Section& section);
    void check(base::Section& section) const;
    bool has_elasticity() const { return E || nu || G || lambda || K; }
    bool is_uniformly_elastic() const;  ///< no value depends on the place
    /// The law at a point. Throws an Error that names the entry, the value and the point where it is out of range.
    laws::Elasticity elasticity(const std::array<Real, 3>& x) const;
    Real density_at(const std::array<Real, 3>& x) const;  ///< likewise; it must be given
  };

  struct Joint : Physics::Joint, JointMaterial {
    void describe(base::Section& section);
    void check(base::Section& section) const { compare_entries(section); }
  };

  struct Bulk : Physics::Bulk {
    bool rigid = false;  ///< it does not deform: no mechanics
    std::vector<base::Expression> body_force;
    std::vector<base::Expression> initial_stress;   ///< XX, YY, ZZ, XY in 2D; XX, YY, ZZ, XY, YZ, XZ in 3D
    std::optional<Lithostatic> lithostatic_stress;  ///< or this
    std::optional<PrincipalStress> in_situ_stress;  ///< or this
    std::vector<Real> release;                      ///< begin and end, see make_release(); empty: none
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
    std::vector<base::Expression> plastic_jump;  ///< tangential, at the start, in the frame of the face
    void describe(base::Section& section);
  };

  struct BoundaryCondition : Physics::BoundaryCondition {
    static constexpr const char* kinds =
        "either \"displacement\", or \"traction\", \"confining pressure\", \"foundation stiffness\" or several of "
        "these";
    std::vector<base::Expression> displacement;    ///< per component; the text "free" leaves one free
    std::vector<Real> lower_corner, upper_corner;  ///< displacements only at nodes in this box; empty: everywhere
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
    /// Of ElasticPlasticJumpParameters; not an entry, for it has no influence on solutions.
    Real augmentation = usual_augmentation();
    /// Nor this: a live model has changed constants of rock or springs, or filled a region.
    bool keeps_stress = false;
    void keep(const Sections& other) {
      augmentation = other.augmentation;
      keeps_stress = other.keeps_stress;
    }
  };

  static bool is_in(const Scene& scene);
  static bool needs_facets(const Scene& scene);
  static std::string no_error_estimate(const Scene& scene);
  static std::vector<QuantityKind> quantities();
  static std::string refuses(const Scene& scene, const Functional& J);
  static std::vector<std::string> fixed_entries();
  static std::vector<std::string> refuses_change(const Scene& before, const Scene& after);
  static std::vector<std::string> refuses_change_in(const mesh::Mesh& mesh, const Scene& before, const Scene& after);
  static void prepare_change(const mesh::Mesh& mesh, const Scene& before, Scene& after);
  static void compare(Comparison& comparison);
  static void compare_mesh(Comparison& comparison, const mesh::GlobalMesh& mesh);
  static void add_modules(const Setting& setting, Modules& modules);
  static std::vector<std::string> warnings(const Setting& setting);
  static std::vector<std::string> plausibility(const Setting& setting, const std::vector<Real>& times);
  static std::vector<std::string> warnings_of_state(const Setting& setting, const std::vector<Real>& times,
                                                    const std::vector<assembly::OutputField>& outputs);
  static std::vector<std::string> doubts(const Setting& setting, bool oscillates);
};

/// Of local cells.
Properties<laws::Elasticity> elasticity(const Scene& scene, const mesh::Mesh& mesh);

/// With displacements of an order; 1: of any. Other unknowns on facets are those of fields with a part in the stress,
/// which the bubbles of facets would have to see.
bool has_solid_pressure(const Scene& scene, int order = 1);

/// Regions of a mesh that a changed scene fills (true), or gives other elastic constants, by their names. Collective.
std::map<std::string, bool> changed_rock(const mesh::Mesh& mesh, const Scene& before, const Scene& after);

/// Young's, Pa. Collective.
Real largest_modulus(const Scene& scene, const mesh::Mesh& mesh);

/// As given, or the lithostatic one; of a region its own, where it has one.
InitialStress initial_stress(const Scene& scene, const mesh::Mesh& mesh);

/// An owned fracture face at the start: its traction in its frame, Pa, and the bound on the shear of its joint.
struct StartOfFace {
  std::array<Real, 3> traction;
  Real bound;
};
/// Of all owned ones; empty without initial stress. Collective.
std::vector<StartOfFace> starts_of_faces(const Setting& setting);

/// g0 of (14), [owned fracture face]; null where it is the same all along the fracture.
std::vector<const base::Expression*> varying_gaps(const Scene& scene, const mesh::Mesh& mesh);

/// Along the normal, of owned fracture faces, m. Collective.
std::vector<Real> initial_openings(const Setting& setting);

}  // namespace sprekk::physics
