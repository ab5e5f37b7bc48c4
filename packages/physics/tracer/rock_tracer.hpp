// Decay and mass of a tracer in rock.
#pragma once

#include "base/types.hpp"

#include <memory>
#include <string>
#include <vector>

namespace sprekk::assembly {
class Module;
struct Total;
}  // namespace sprekk::assembly

namespace sprekk::mesh {
struct Mesh;
}

namespace sprekk::physics {

/// Creates the module that adds decay V C c to the rows of "concentration", with the capacity C = R porosity of local
/// cells and the decay constant, 1/s. Totals "tracer": mass "in rock" with its sorbed part, and "decay", mass per time.
std::unique_ptr<assembly::Module> make_rock_tracer(std::vector<Real> capacity, Real decay);

/// Appends this rank's totals "tracer": the mass at `place`, kg, and the decay, kg/s (2D: per metre).
void add_tracer_totals(const mesh::Mesh& mesh, const std::string& place, Real mass, Real decay,
                       std::vector<assembly::Total>& totals);

}  // namespace sprekk::physics
