// Flow of a fluid through rock and fractures: scene entries and modules.
#pragma once

#include "base/expression.hpp"
#include "fields/properties.hpp"
#include "laws/darcy.hpp"
#include "physics/physics.hpp"
#include "transport/flux_scheme.hpp"
#include "transport/storage.hpp"

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::physics {

/// Well: a line that injects or extracts fluid.
struct WellSection {
  std::vector<Real> points;  ///< 2D: one point; 3D: points of a polyline
  Real radius = 0, skin = 0;
  std::optional<base::Expression> rate, pressure;  ///< exactly one is given
  void describe(base::Section& section);
};

/// Channel along intersections of fractures in 3D.
struct IntersectionSection {
  std::vector<std::string> fractures;               ///< names; empty: all intersections
  std::optional<Real> diameter, permeability_area;  ///< exactly one is given
  Real conductance(Real viscosity) const;           ///< flow per pressure gradient, m^4/(Pa s)
  void describe(base::Section& section);
};

/// Pressure prescribed at a point or along a line of a fracture.
struct HeldPressureSection {
  base::Expression pressure = 0;
  std::vector<Real> lower_corner, upper_corner;  ///< box; no upper corner: a point
  void describe(base::Section& section);
};

/// Fluid that flows through rock and fractures.
struct FlowSection {
  bool rigid_rock = false;  ///< the rock does not deform; no mechanics
  Real viscosity = 1e-3, density = 1000, compressibility = 0, reference_pressure = 0;
  base::Expression source = 0, initial_pressure = 0;
  std::string scheme = "auto";
  std::map<std::string, WellSection> wells;
  std::map<std::string, IntersectionSection> intersections;
  void describe(base::Section& section);
};

/// Fluid of a host program in the pores and fractures of deforming rock. It replaces FlowSection. The materials require
/// only "Biot coefficient" and the aperture of joints.
struct HostFluid {
  /// True: modules of the host declare the unknowns "pressure" (cells) and "face pressure" (facets, see mesh::Facets)
  /// and write their rows, the balance of volume per time. Sprekk adds the coupling of these rows and of momentum with
  /// displacements, see physics::make_poroelastic_coupling(). False: the host prescribes pressures by
  /// set_fluid_pressure().
  bool unknown = false;
  Real initial_pressure = 0;  ///< pressure at which the initial state is in equilibrium, Pa
};

struct Flow : Physics<Flow> {
  struct Rock : Physics::Rock {
    std::vector<base::Expression> permeability;  ///< one value, or tensor components; functions of x, y, z; 0: none
    base::Expression porosity = 0;
    /// Compressibility of the pores; Biot's modulus. At most one is given.
    std::optional<Real> compressibility, biot_modulus;
    void describe(base::Section& section);
    void check(base::Section& section) const;
    bool flows_uniformly() const;  ///< the permeability is independent of the position
    bool is_impermeable() const;   ///< the permeability is 0 everywhere
    /// Mobility k/mu. Throws an Error if k is not a positive definite tensor of dimension `dim`.
    laws::Mobility mobility(int dim, Real viscosity, const std::array<Real, 3>& x) const;
    /// Storage capacity of the pores at constant strain, for the fluid compressibility `of_fluid`, 1/Pa. Throws an
    /// Error if pores and fluid are inconsistent.
    transport::Capacity capacity(Real of_fluid, const std::array<Real, 3>& x) const;
    bool may_store(Real of_fluid) const;  ///< storage is possible somewhere
  };

  struct Joint : Physics::Joint {
    base::Expression residual_aperture = 0;
    std::optional<base::Expression> tangential_permeability;  ///< absent: cubic law
    base::Expression normal_permeability = std::numeric_limits<Real>::infinity();
    void describe(base::Section& section);
  };

  struct Region : Physics::Region {
    std::optional<base::Expression> pressure;  ///< prescribed at all times
    void describe(base::Section& section);
    bool is_given() const { return pressure.has_value(); }
    std::vector<Prescribed> prescribed() const;
  };

  struct Fracture : Physics::Fracture {
    base::Expression source = 0;
    std::vector<std::string> cuts;  ///< names of fractures that the filling of this fracture divides
    std::map<std::string, HeldPressureSection> held_pressures;
    void describe(base::Section& section);
    std::vector<Prescribed> prescribed() const;
  };

  struct BoundaryCondition : Physics::BoundaryCondition {
    static constexpr const char* kinds = "with \"Flow\" either \"pressure\" or \"flux\"";
    std::optional<base::Expression> pressure, flux, conductance;
    void describe(base::Section& section);
    void check(base::Section& section) const;
    bool is_given() const { return pressure || flux; }
    std::vector<Prescribed> prescribed() const;
  };

  struct Probe : Physics::Probe {
    static constexpr const char* kinds = "\"well\"";
    std::optional<std::string> well;
    void describe(base::Section& section);
    bool is_given() const { return well.has_value(); }
    std::vector<std::string> totals() const;
  };

  struct Sections : Physics::Sections {
    std::optional<FlowSection> flow;
    std::optional<HostFluid> host_fluid;  ///< not a scene entry
    void describe(base::Section& section);
    void keep(const Sections& other) { host_fluid = other.host_fluid; }
  };

  static bool is_in(const Scene& scene);
  static std::vector<std::string> fixed_entries() { return {"initial pressure"}; }
  static Facets needs_facets(const Scene& scene);
  static bool has_initial_state(const Scene& scene);
  static void compare(Comparison& comparison);
  static void add_modules(const Setting& setting, Modules& modules);
  static std::vector<std::string> warnings(const Setting& setting);

  struct Rates {
    static bool exist(const Scene& scene);
    static std::vector<std::string> sections() { return {"Flow"}; }
    static std::string implicit_euler(const Scene&) { return ""; }
  };
  struct Estimate {
    static std::string missing(const Scene& scene);
    static std::vector<estimate::QuantityKind> quantities();
    static std::string refuses(const Scene& scene, const estimate::Functional& J);
    static std::unique_ptr<estimate::MeshError> mesh_error(const Setting& setting, assembly::System& system);
  };
  struct Warnings {
    static std::vector<std::string> of_input(const Setting& setting, const std::vector<Real>& times);
    static std::vector<std::string> of_state(const Setting& setting, const std::vector<Real>& times,
                                             const std::vector<assembly::OutputField>& outputs);
  };
};

/// Returns whether the scene has a fluid: Flow, or the fluid of a host.
bool has_fluid(const Scene& scene);
/// Returns whether fluid flows in the rock: with Flow, the permeability is not 0.
bool flows_in_rock(const Scene& scene);
/// Returns whether the fluid pressure is an unknown.
bool has_unknown_pressure(const Scene& scene);
/// Initial pressure of the fluid in rock and fractures, Pa; 0 without a fluid.
base::Expression initial_pressure(const Scene& scene);

/// Initial mechanical aperture (15) of a fracture face without its lower bound, and this bound (residual aperture), m.
struct StartAperture {
  Real value, minimum;
};
/// Initial apertures of local fracture faces. Collective.
std::vector<StartAperture> start_apertures(const Setting& setting);

/// Entry "scheme" of the flow section.
transport::SchemeEntry scheme_entry(const Scene& scene);
/// Mobilities of local cells.
fields::Properties<laws::Mobility> mobility(const Scene& scene, const mesh::Mesh& mesh);

}  // namespace sprekk::physics
