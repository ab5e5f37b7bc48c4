// Coupling of flow and mechanics in scenes with both.
#pragma once

#include "physics/physics.hpp"
#include "physics/poroelasticity/given_pressure.hpp"
#include "physics/poroelasticity/hydraulic_opening.hpp"
#include "transport/stabilisation.hpp"

namespace sprekk::physics {

struct Poroelasticity : Physics<Poroelasticity> {
  struct Rock : Physics::Rock {
    base::Expression biot = 1;  ///< Biot's coefficient
    void describe(base::Section& section);
  };

  struct Joint : Physics::Joint {
    base::Expression filling_biot = 1;  ///< Biot's coefficient of the filling; 1: open joint
    void describe(base::Section& section);
  };

  static bool is_in(const Scene& scene);
  static std::vector<std::string> fixed_entries() { return {"Biot coefficient"}; }
  static void compare(Comparison& comparison);
  static void add_modules(const Setting& setting, Modules& modules);
  static std::vector<std::string> warnings(const Setting& setting);

  struct Warnings {
    static std::vector<std::string> of_input(const Setting& setting, const std::vector<Real>& times);
    static std::vector<std::string> of_state(const Setting& setting, const std::vector<Real>&,
                                             const std::vector<assembly::OutputField>& outputs) {
      return is_in(setting.scene) ? opening_by_rate_doubts(setting, outputs) : std::vector<std::string>();
    }
  };
};

/// Stabilisation of the fluid pressure in deforming rock; empty without poroelasticity. Collective.
transport::Stabilisation stabilisation(const Scene& scene, const mesh::Mesh& mesh);

/// Biot's coefficients alpha_f of fillings, [local fracture face]. The fluid pressure p adds -alpha_f p n to the
/// traction on the sides, and a widening b increases the volume of the fluid by alpha_f b. Throws an Error if a
/// coefficient is not between 0 and 1. Local.
std::vector<Real> filling_biot(const Scene& scene, const mesh::Mesh& mesh);

}  // namespace sprekk::physics
