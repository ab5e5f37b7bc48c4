// Spatial error of a flow and of its potential.
#pragma once

#include "assembly/system.hpp"
#include "estimate/mesh_error.hpp"
#include "transport/hybrid_error.hpp"
#include "transport/wells.hpp"

#include <memory>
#include <optional>

namespace sprekk::transport {

struct BalanceErrorParameters {
  std::string field;    ///< on cells; on facets with "face " before it
  std::string flux;     ///< name of the transported quantity
  std::string power;    ///< unit of the dissipation: flux times gradient of the potential, integrated over a volume
  std::string inflows;  ///< name of the reactions and totals of boundaries
  /// Functional::what of the potential and of the flow, each with its name in the Totals of wells.
  struct Name {
    std::string what, of_well;
  };
  Name potential, flow;
  HybridErrorParameters error;
  Real start = 0;  ///< time of the initial state, s
  /// [local fracture face] conduits with a transmissivity that depends on "widening"; none: constant.
  std::optional<std::vector<laws::Conduit>> conduits = {};
  WellsParameters wells = {};  ///< wells connected to the balance
  /// Fluid flow that transports the quantity by upwinding: `capacity` per volume and unit of the potential.
  struct Carrier {
    HybridFluxParameters flow;
    std::vector<laws::Conduit> conduits = {};
    Real capacity;
  };
  std::optional<Carrier> carrier = {};
};

/// Creates the HybridError of the balance of `field`, with these functionals:
///
/// - the potential of a well, or its mean over fractures;
/// - the flow into the rock and the fractures, from a well or through a boundary. The derivative of a boundary flow
///   includes only the facets with prescribed potential.
///
/// The index W of a well in rock (see make_wells()) corrects the discretisation error of the cells around the well. The
/// error is therefore zero in the cell of the well and in cells that share a corner with it. With such wells,
/// functionals have no value: throws an Error. The result holds a reference to the system. Collective.
std::unique_ptr<estimate::MeshError> make_balance_error(assembly::System& system, BalanceErrorParameters parameters);

}  // namespace sprekk::transport
