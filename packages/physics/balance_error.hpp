// The error of what flows and of its potential, as far as the mesh is to blame.
#pragma once

#include "assembly/system.hpp"
#include "physics/flow/wells.hpp"
#include "physics/hybrid_error.hpp"

#include <functional>
#include <memory>
#include <optional>

namespace sprekk::physics {

struct BalanceErrorParameters {
  std::string field;  ///< on cells; on facets with "face " before it
  std::string flux;   ///< name of what flows
  std::string power;  ///< unit of what that dissipates, flux times gradient of the potential, integrated over a volume
  std::string inflows;  ///< name of the reactions and totals of boundaries
  /// Functional::what of the potential and of what flows, each with what Totals of wells call it.
  struct Name {
    std::string what, of_well;
  };
  Name potential, flow;
  HybridErrorParameters error;
  Real start = 0;  ///< time of the initial state
  /// [local fracture face], whose transmissivity follows "widening"; none: it does not.
  std::optional<std::vector<laws::Conduit>> conduits = {};
  WellsParameters wells = {};  ///< whose connections take part in the balance
  /// A fluid's flow that carries `capacity` of it per volume and unit of the potential, upwind.
  struct Carrier {
    HybridFluxParameters flow;
    std::vector<laws::Conduit> conduits = {};
    Real capacity;
  };
  std::optional<Carrier> carrier = {};
};

/// HybridError of the system's balance of that field, with these functionals: the potential of a well, or its mean over
/// fractures; and what flows into the rock and the fractures, from a well, or through a boundary, of which the
/// derivative is that where the potential is prescribed. A well of the balance in rock is told apart from the cells
/// around it by its index W, see make_wells(), which makes up for what they miss: nothing is in error in a well's cell
/// and those that share a corner with it, and with such wells functionals have no value: Error. Refers to the system.
/// Collective.
std::unique_ptr<MeshError> make_balance_error(assembly::System& system, BalanceErrorParameters parameters);

}  // namespace sprekk::physics
