// Coupling of flow and mechanics in scenes with both.
#pragma once

#include "physics/physics.hpp"
#include "physics/poroelasticity/given_pressure.hpp"
#include "transport/stabilisation.hpp"

namespace sprekk::physics {

struct Poroelasticity : Physics<Poroelasticity> {
  struct Rock : Physics::Rock {
    base::Expression biot = 1;  ///< Biot's coefficient
    void describe(base::Section& section);
  };

  static bool is_in(const Scene& scene);
  static std::vector<std::string> fixed_entries() { return {"Biot coefficient"}; }
  static void add_modules(const Setting& setting, Modules& modules);
  static std::vector<std::string> warnings(const Setting& setting);
};

/// Stabilisation of the fluid pressure in deforming rock; empty without poroelasticity. Collective.
transport::Stabilisation stabilisation(const Scene& scene, const mesh::Mesh& mesh);

}  // namespace sprekk::physics
