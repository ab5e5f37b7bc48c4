// Heat in rock and fractures: conduction, advection by a fluid and thermal stress. Scene entries and modules.
#pragma once

#include "base/expression.hpp"
#include "laws/darcy.hpp"
#include "physics/physics.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::physics {

/// Temperature of the fluid that a well of Flow injects.
struct WellTemperature {
  base::Expression temperature = 0;
  void describe(base::Section& section);
};

struct HeatSection {
  base::Expression source = 0;
  std::optional<base::Expression> initial_temperature;  ///< required with heat storage or thermal expansion
  std::optional<Real> fluid_capacity;                   ///< per volume, required with Flow
  Real fluid_expansion = 0;                             ///< volumetric
  std::string fluid = "constant";                       ///< dependence of the fluid of Flow on T
  Real viscosity_decay = 0;                             ///< for fluid "exponential"
  Real reference_temperature = 293.15;                  ///< T_0 for density and viscosity of Flow
  std::string scheme = "auto", advection = "upwind";
  bool of_friction = false;                      ///< friction heats sliding fractures
  std::map<std::string, WellTemperature> wells;  ///< by names of the wells of Flow
  void describe(base::Section& section);
  /// Effect of the temperature on density and viscosity; none: constant fluid.
  std::optional<transport::FluidChange> fluid_change() const;
};

struct Heat : Physics<Heat> {
  struct Rock : Physics::Rock {
    std::vector<base::Expression> thermal_conductivity;  ///< one value, or tensor components; functions of x, y, z
    base::Expression heat_capacity = 0;                  ///< per volume; function of x, y, z
    base::Expression thermal_expansion = 0;              ///< linear; function of x, y, z
    void describe(base::Section& section);
    bool conducts_uniformly() const;  ///< the conductivity is independent of the position
    /// K in Fourier's law q = -K grad T. Throws an Error if K is not a positive definite tensor of dimension `dim`.
    laws::Mobility conductivity(int dim, const std::array<Real, 3>& x) const;
  };

  /// Thermal properties of the filling.
  struct Joint : Physics::Joint {
    base::Expression filling_conductivity = 0.6;            ///< default: water
    std::optional<base::Expression> filling_heat_capacity;  ///< absent: that of the fluid of Flow; without a fluid 0
    void describe(base::Section& section);
  };

  struct Region : Physics::Region {
    std::optional<base::Expression> temperature;  ///< prescribed at all times
    void describe(base::Section& section);
    bool is_given() const { return temperature.has_value(); }
    std::vector<Prescribed> prescribed() const;
  };

  struct BoundaryCondition : Physics::BoundaryCondition {
    static constexpr const char* kinds = "with \"Heat\" either \"temperature\" or \"heat flux\"";
    std::optional<base::Expression> temperature, heat_flux, heat_transfer_coefficient;
    void describe(base::Section& section);
    void check(base::Section& section) const;
    bool is_given() const { return temperature || heat_flux; }
    std::vector<Prescribed> prescribed() const;
  };

  struct Sections : Physics::Sections {
    std::optional<HeatSection> heat;
    void describe(base::Section& section);
  };

  static bool is_in(const Scene& scene);
  static std::vector<std::string> fixed_entries() { return {"initial temperature", "thermal expansion"}; }
  static Facets needs_facets(const Scene& scene) { return is_in(scene) ? Facets::all : Facets::none; }
  static bool has_initial_state(const Scene& scene);
  static void compare(Comparison& comparison);
  static void add_modules(const Setting& setting, Modules& modules);
  static std::vector<std::string> warnings(const Setting& setting);

  struct Rates {
    static bool exist(const Scene& scene) { return is_in(scene); }
    static std::vector<std::string> sections() { return {"Heat"}; }
    static std::string implicit_euler(const Scene& scene);
  };
  struct Transport {
    static std::vector<CarriedQuantity> carried(const Scene& scene);
    static std::string friction_power(const Scene& scene);
  };
  struct Estimate {
    static std::string missing(const Scene& scene);
    static std::vector<estimate::QuantityKind> quantities();
    static std::string refuses(const Scene& scene, const estimate::Functional& J);
    static std::unique_ptr<estimate::MeshError> mesh_error(const Setting& setting, assembly::System& system);
  };
  struct Change {
    static std::vector<std::string> refuses(const Scene&, const Scene&) { return {}; }
    static std::vector<std::string> refuses_in(const mesh::Mesh& mesh, const Scene& before, const Scene& after);
    static void prepare(const mesh::Mesh&, const Scene&, Scene&) {}
  };
  struct Warnings {
    static std::vector<std::string> of_input(const Setting& setting, const std::vector<Real>& times);
    static std::vector<std::string> of_state(const Setting& setting, const std::vector<Real>& times,
                                             const std::vector<assembly::OutputField>& outputs);
  };
};

}  // namespace sprekk::physics
