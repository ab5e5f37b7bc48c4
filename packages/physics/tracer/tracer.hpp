// Transport of a dissolved tracer in rock and fractures: diffusion, advection, dispersion, sorption and decay.
#pragma once

#include "base/expression.hpp"
#include "laws/darcy.hpp"
#include "physics/physics.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::physics {

/// Concentration of the fluid that a well of Flow injects.
struct WellConcentration {
  base::Expression concentration = 0;
  void describe(base::Section& section);
};

struct TracerSection {
  base::Expression source = 0, initial_concentration = 0;
  std::optional<Real> half_life;
  std::string scheme = "auto", advection = "upwind";
  std::map<std::string, WellConcentration> wells;  ///< by names of the wells of Flow
  void describe(base::Section& section);
  Real decay() const;  ///< decay constant ln 2/half life, 1/s; 0 without a half life
};

/// Dispersivities alpha_L and alpha_T, m, along and across the flow.
struct Dispersivity {
  Real along = 0, across = 0;
  void describe(base::Section& section);
  bool is_any() const { return along > 0 || across > 0; }
};

struct Tracer : Physics<Tracer> {
  struct Rock : Physics::Rock {
    std::vector<base::Expression> effective_diffusion;  ///< one value, or tensor components; functions of x, y, z
    base::Expression retardation = 1;                   ///< function of x, y, z
    Dispersivity dispersivity;
    void describe(base::Section& section);
    bool diffuses_uniformly() const;  ///< the diffusion coefficient is independent of the position
    /// D_e in Fick's law j = -D_e grad c. Throws an Error if it is not a positive definite tensor of dimension `dim`.
    laws::Mobility diffusion(int dim, const std::array<Real, 3>& x) const;
  };

  struct Joint : Physics::Joint {
    base::Expression filling_diffusion = 1e-9;  ///< default: ions in water
    base::Expression filling_retardation = 1;
    Dispersivity filling_dispersivity;
    void describe(base::Section& section);
  };

  struct BoundaryCondition : Physics::BoundaryCondition {
    static constexpr const char* kinds = "with \"Tracer\" either \"concentration\" or \"tracer flux\"";
    std::optional<base::Expression> concentration, tracer_flux, tracer_transfer;
    void describe(base::Section& section);
    void check(base::Section& section) const;
    bool is_given() const { return concentration || tracer_flux; }
    std::vector<Prescribed> prescribed() const;
  };

  struct Sections : Physics::Sections {
    std::optional<TracerSection> tracer;
    void describe(base::Section& section);
  };

  static bool is_in(const Scene& scene);
  static std::vector<std::string> fixed_entries() { return {"initial concentration"}; }
  static Facets needs_facets(const Scene& scene) { return is_in(scene) ? Facets::all : Facets::none; }
  static void compare(Comparison& comparison);
  static void add_modules(const Setting& setting, Modules& modules);
  static std::vector<std::string> warnings(const Setting& setting);

  struct Rates {
    static bool exist(const Scene& scene) { return is_in(scene); }
    static std::vector<std::string> sections() { return {"Tracer"}; }
    static std::string implicit_euler(const Scene& scene);
  };
  struct Transport {
    static std::vector<CarriedQuantity> carried(const Scene& scene);
    static std::string friction_power(const Scene&) { return ""; }
  };
  struct Estimate {
    static std::string missing(const Scene& scene);
    static std::vector<estimate::QuantityKind> quantities();
    static std::string refuses(const Scene& scene, const estimate::Functional& J);
    static std::unique_ptr<estimate::MeshError> mesh_error(const Setting& setting, assembly::System& system);
  };
};

/// Returns whether the rock or a joint of a scene has a dispersivity.
bool has_dispersivity(const Scene& scene);

}  // namespace sprekk::physics
