// Conduction of heat through rock: its entries of a scene and its modules.
#pragma once

#include "base/expression.hpp"
#include "laws/darcy.hpp"
#include "physics/physics.hpp"

#include <optional>
#include <string>
#include <vector>

namespace sprekk::physics {

struct HeatSection {
  base::Expression source = 0;
  std::optional<base::Expression> initial_temperature;  ///< needed where heat is stored
  std::string scheme = "auto";
  void describe(base::Section& section);
};

struct Heat : Physics<Heat> {
  struct Rock : Physics::Rock {
    std::vector<base::Expression> thermal_conductivity;  ///< one value, or those of a tensor; of x, y, z
    base::Expression heat_capacity = 0;                  ///< per volume; of x, y, z
    void describe(base::Section& section);
    bool conducts_uniformly() const;  ///< the conductivity does not depend on the place
    /// K in Fourier's law q = -K grad T. Throws an Error where it is no positive definite tensor of that dimension.
    laws::Mobility conductivity(int dim, const std::array<Real, 3>& x) const;
  };

  struct Region : Physics::Region {
    std::optional<base::Expression> temperature;  ///< at all times
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
  static bool needs_facets(const Scene& scene) { return is_in(scene); }
  static bool has_rates(const Scene& scene) { return is_in(scene); }
  static bool has_initial_state(const Scene& scene);
  static std::vector<std::string> sections_with_rates() { return {"Heat"}; }
  static void compare(Comparison& comparison);
  static void add_modules(const Setting& setting, Modules& modules);
  static std::vector<std::string> warnings(const Setting& setting);
};

}  // namespace sprekk::physics
