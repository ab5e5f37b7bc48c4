// Flow of a fluid through rock and fractures: its entries of a scene and its modules.
#pragma once

#include "base/expression.hpp"
#include "laws/darcy.hpp"
#include "physics/flux_scheme.hpp"
#include "physics/physics.hpp"
#include "physics/properties.hpp"
#include "physics/storage.hpp"

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::physics {

/// A line from which fluid flows into the rock, or back.
struct WellSection {
  std::vector<Real> points;  ///< 2D: one; 3D: of a polyline
  Real radius = 0, skin = 0;
  std::optional<base::Expression> rate, pressure;  ///< exactly one
  void describe(base::Section& section);
};

/// A fluid that flows through the rock.
struct FlowSection {
  bool rigid_rock = false;  ///< the rock does not deform: no mechanics
  Real viscosity = 1e-3, density = 1000, compressibility = 0, reference_pressure = 0;
  base::Expression source = 0, initial_pressure = 0;
  std::string scheme = "auto";
  std::map<std::string, WellSection> wells;
  void describe(base::Section& section);
};

/// A fluid of a host's in the pores and fractures of rock that deforms, instead of FlowSection. Of materials, "Biot
/// coefficient" counts, of joints the aperture.
struct HostFluid {
  /// The host's modules declare the unknowns "pressure" (cells) and "face pressure" (facets, see mesh::Facets) and
  /// write their rows, the balance of volume per time; what displacements add to them, and they to momentum, is
  /// Sprekk's, see physics::make_poroelastic_coupling(). If not, the host gives pressures:
  /// set_fluid_pressure().
  bool unknown = false;
  Real initial_pressure = 0;  ///< under which the initial state is one of rest, Pa
};

struct Flow : Physics<Flow> {
  struct Rock : Physics::Rock {
    std::vector<base::Expression> permeability;  ///< one value, or those of a tensor; of x, y, z
    base::Expression porosity = 0;
    /// Of the pores; Biot's modulus. At most one.
    std::optional<Real> compressibility, biot_modulus;
    void describe(base::Section& section);
    void check(base::Section& section) const;
    bool flows_uniformly() const;  ///< the permeability does not depend on the place
    /// k/mu. Throws an Error where k is no positive definite tensor of that dimension.
    laws::Mobility mobility(int dim, Real viscosity, const std::array<Real, 3>& x) const;
    /// Of the pores at constant strain, where the fluid has this compressibility, 1/Pa. Throws an Error where pores and
    /// fluid do not fit together.
    Capacity capacity(Real of_fluid, const std::array<Real, 3>& x) const;
    bool may_store(Real of_fluid) const;  ///< somewhere
  };

  struct Joint : Physics::Joint {
    base::Expression residual_aperture = 0;
    std::optional<base::Expression> tangential_permeability;  ///< absent: the cubic law
    base::Expression normal_permeability = std::numeric_limits<Real>::infinity();
    void describe(base::Section& section);
  };

  struct Region : Physics::Region {
    std::optional<base::Expression> pressure;  ///< at all times
    void describe(base::Section& section);
    bool is_given() const { return pressure.has_value(); }
    std::vector<Prescribed> prescribed() const;
  };

  struct Fracture : Physics::Fracture {
    base::Expression source = 0;
    std::vector<std::string> cuts;  ///< names of fractures that its filling divides
    void describe(base::Section& section);
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
    std::optional<HostFluid> host_fluid;  ///< not an entry
    void describe(base::Section& section);
    void keep(const Sections& other) { host_fluid = other.host_fluid; }
  };

  static bool is_in(const Scene& scene);
  static std::vector<std::string> fixed_entries() { return {"initial pressure"}; }
  static bool needs_facets(const Scene& scene);
  static bool has_rates(const Scene& scene);
  static bool has_initial_state(const Scene& scene);
  static std::vector<std::string> sections_with_rates() { return {"Flow"}; }
  static std::string no_error_estimate(const Scene& scene);
  static std::vector<QuantityKind> quantities();
  static std::string refuses(const Scene& scene, const Functional& J);
  static std::unique_ptr<MeshError> mesh_error(const Setting& setting, assembly::System& system);
  static void compare(Comparison& comparison);
  static void add_modules(const Setting& setting, Modules& modules);
  static std::vector<std::string> warnings(const Setting& setting);
  static std::vector<std::string> warnings_of_state(const Setting& setting, const std::vector<Real>& times,
                                                    const std::vector<assembly::OutputField>& outputs);
};

/// A fluid that flows, or a host's.
bool has_fluid(const Scene& scene);
/// Its pressure is an unknown.
bool has_unknown_pressure(const Scene& scene);
/// Of the fluid in rock and fractures; 0 without.
base::Expression initial_pressure(const Scene& scene);

/// The mechanical aperture (15) of a fracture face, m: at the start, without its lower bound, and that bound.
struct StartAperture {
  Real value, least;
};
/// Of local fracture faces. Collective.
std::vector<StartAperture> start_apertures(const Setting& setting);

SchemeEntry scheme_entry(const Scene& scene);
/// Of local cells.
Properties<laws::Mobility> mobility(const Scene& scene, const mesh::Mesh& mesh);

}  // namespace sprekk::physics
